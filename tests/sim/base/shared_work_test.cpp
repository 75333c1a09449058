// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/shared_work.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <vector>

#include "sim/base/thread_pool.hpp"

namespace {

using sim::SharedWork;

/// Work of 1 s, of which `part` is shared in many pieces.
SharedWork work_of(double part, double max_piece_s = 0) {
  return {1 - part, part, max_piece_s, 100};
}

TEST(SharedWork, TimesFollowAmdahlsLaw) {
  EXPECT_DOUBLE_EQ(work_of(0.8).time_s(1), 1);
  EXPECT_DOUBLE_EQ(work_of(0.8).time_s(4), 0.4);
  EXPECT_DOUBLE_EQ(work_of(0.8).shared_part(), 0.8);
}

TEST(SharedWork, TheLongestPieceIsNotDivided) {
  EXPECT_DOUBLE_EQ(work_of(0.8, 0.5).time_s(1), 1);
  EXPECT_DOUBLE_EQ(work_of(0.8, 0.5).time_s(4), 0.7);
}

TEST(SharedWork, ThreadsAreUsefulWhileTwiceAsManyGainATenth) {
  // (s + p / n) / (s + p / 2n) >= 1.1 up to n = 4.5 p / s.
  EXPECT_EQ(work_of(0).useful_threads(), 1);
  EXPECT_EQ(work_of(0.5).useful_threads(), 5);
  EXPECT_EQ(work_of(0.75).useful_threads(), 14);
}

TEST(SharedWork, AdvisesWhereMoreThreadsGainLittle) {
  EXPECT_EQ(work_of(0.1).advice(8),
            "more than 1 thread would gain less than a tenth: they share 10 % of the work of a step");
  EXPECT_EQ(work_of(0.5).advice(8),
            "more than 5 threads would gain less than a tenth: they share 50 % of the work of a step");
  EXPECT_EQ(work_of(0.9).advice(2), "") << "more threads would help";
  EXPECT_EQ((SharedWork{1, 0, 0, 3}).advice(8), "") << "too few steps";
}

TEST(SharedWork, IsMeasuredWhereAPoolSharesIt) {
  sim::ThreadPool pool(2);
  std::atomic<double> sink = 0;
  const auto work = [&](std::size_t i) {
    double sum = 0;
    for (int k = 1; k < 2'000'000; ++k) sum += std::sqrt(static_cast<double>(k) + static_cast<double>(i));
    sink = sum;
  };
  SharedWork measured;
  pool.for_each(8, work);
  EXPECT_EQ(measured.steps, 0) << "no clock was read";
  {
    const sim::SharedWorkClock clock(&measured);
    pool.for_each(8, work);
  }
  EXPECT_EQ(measured.steps, 1);
  EXPECT_GT(measured.max_piece_s, 0);
  EXPECT_GT(measured.shared_s, measured.max_piece_s);
  const double before_s = measured.shared_s;
  pool.for_each(8, work);
  EXPECT_EQ(measured.shared_s, before_s) << "it ended with the clock";
}

TEST(SharedWork, PiecesWithinPiecesAreSharedAndCounted) {
  sim::ThreadPool pool(3);
  std::vector<int> done(40, 0);
  const auto all = [&] {
    pool.for_each(4, [&](std::size_t i) { sim::for_each_within(10, [&](std::size_t k) { ++done[10 * i + k]; }); });
  };
  SharedWork measured;
  all();
  {
    const sim::SharedWorkClock clock(&measured);
    all();
  }
  sim::for_each_within(40, [&](std::size_t k) { ++done[k]; });  // alone
  EXPECT_EQ(done, std::vector<int>(40, 3));
  EXPECT_GT(measured.shared_s, 0);
}

}  // namespace
