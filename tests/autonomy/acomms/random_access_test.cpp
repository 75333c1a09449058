// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/random_access.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "autonomy/acomms/tdma.hpp"

namespace {

using autonomy::RandomAccess;
using test::second;

constexpr std::int64_t epoch = 1'767'225'600 * second;  // a multiple of 20 s

TEST(RandomAccess, ScattersAboutItsMean) {
  RandomAccess access(10, 0.5, 1, "auv");
  std::vector<std::int64_t> turns;
  for (std::int64_t t = 0; t < 20'000 * second; t += second / 100)
    if (access.take_turn(t)) turns.push_back(t);
  ASSERT_GT(turns.size(), 1000u);
  for (std::size_t i = 1; i < turns.size(); ++i) {
    EXPECT_GE(turns[i] - turns[i - 1], 5 * second);
    EXPECT_LE(turns[i] - turns[i - 1], 15 * second + second / 100);
  }
  // 2000 intervals with a standard deviation of 10 / sqrt(12): their mean to 0.065 s, four sigma.
  const double mean_s =
      static_cast<double>(turns.back() - turns.front()) * 1e-6 / static_cast<double>(turns.size() - 1);
  EXPECT_NEAR(mean_s, 10, 0.26);
  EXPECT_LE(turns.front(), 10 * second);
}

TEST(RandomAccess, ClockThatIsSetBackDoesNotSilenceIt) {
  RandomAccess access(10, 0.5, 1, "auv");
  for (std::int64_t t = 0; t < 100 * second; t += second / 10) access.take_turn(epoch + 3600 * second + t);
  std::vector<std::int64_t> turns;
  for (std::int64_t t = 0; t < 300 * second; t += second / 10)
    if (access.take_turn(epoch + t)) turns.push_back(t);
  ASSERT_GE(turns.size(), 19u);  // the first within 10 s, the others each 15 s at the latest
  EXPECT_LE(turns.front(), 10 * second);
  for (std::size_t i = 1; i < turns.size(); ++i) EXPECT_GE(turns[i] - turns[i - 1], 5 * second - second / 10);
}

TEST(RandomAccess, SameSeedAndNameGiveTheSameTurns) {
  const auto turns = [](std::uint64_t seed, const char* name) {
    RandomAccess access(10, 1, seed, name);
    std::vector<std::int64_t> all;
    for (std::int64_t t = 0; t < 500 * second; t += second / 10)
      if (access.take_turn(t)) all.push_back(t);
    return all;
  };
  EXPECT_EQ(turns(1, "a"), turns(1, "a"));
  EXPECT_NE(turns(1, "a"), turns(1, "b"));
  EXPECT_NE(turns(1, "a"), turns(2, "a"));
}

TEST(RandomAccess, ParametersAreChecked) {
  EXPECT_THROW(RandomAccess(0, 0.5, 1, "a"), std::invalid_argument);
  EXPECT_THROW(RandomAccess(1, 1.5, 1, "a"), std::invalid_argument);
  EXPECT_THROW(RandomAccess(1, -0.1, 1, "a"), std::invalid_argument);
}

}  // namespace
