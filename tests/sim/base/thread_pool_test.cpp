// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/thread_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace {

TEST(ThreadPool, DoesEachPieceOnceWithAnyNumberOfThreads) {
  for (const int threads : {1, 2, 7}) {
    sim::ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    std::vector<std::atomic<int>> done(1000);
    pool.for_each(done.size(), [&](std::size_t i) { ++done[i]; });
    for (const auto& times : done) EXPECT_EQ(times, 1);
  }
}

TEST(ThreadPool, OfZeroHasAThreadForEachProcessor) {
  EXPECT_EQ(sim::ThreadPool(0).threads(), static_cast<int>(std::max(1u, std::thread::hardware_concurrency())));
}

TEST(ThreadPool, ThrowsWhatAPieceThrowsAndWorksOn) {
  for (const int threads : {1, 3}) {
    sim::ThreadPool pool(threads);
    const auto fail = [](std::size_t i) {
      if (i == 5) throw std::runtime_error("piece 5");
    };
    EXPECT_THROW(pool.for_each(10, fail), std::runtime_error);
    std::atomic<int> done{0};
    pool.for_each(10, [&](std::size_t) { ++done; });
    EXPECT_EQ(done, 10);
  }
}

TEST(ThreadPool, APieceMayShareWorkItself) {
  sim::ThreadPool pool(2);
  std::atomic<int> done{0};
  pool.for_each(4, [&](std::size_t) { pool.for_each(5, [&](std::size_t) { ++done; }); });
  EXPECT_EQ(done, 20);
}

/// The numbers of the blocks of for_each_block, each by its place.
std::vector<int> blocks_of(sim::ThreadPool* pool, std::size_t count) {
  std::vector<int> sizes(count, 0);
  sim::for_each_block(pool, count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sizes[i] = static_cast<int>(end - begin);
  });
  return sizes;
}

TEST(ForEachBlock, FewObjectsAreOneBlockInThisThread) {
  sim::ThreadPool pool(2);
  EXPECT_EQ(blocks_of(&pool, sim::min_shared - 1),
            std::vector<int>(sim::min_shared - 1, static_cast<int>(sim::min_shared) - 1));
  EXPECT_EQ(blocks_of(nullptr, 100), std::vector<int>(100, 100));
  EXPECT_EQ(blocks_of(&pool, 0), std::vector<int>());
}

TEST(ForEachBlock, ManyObjectsAreInBlocksOf32AndARest) {
  sim::ThreadPool pool(2);
  std::vector<int> expected(64, 32);
  expected.insert(expected.end(), 6, 6);
  EXPECT_EQ(blocks_of(&pool, 70), expected);
}

}  // namespace
