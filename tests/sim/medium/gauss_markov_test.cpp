// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/gauss_markov.hpp"

#include <gtest/gtest.h>

namespace {

using sim::Time;

sim::GaussMarkov process() {
  return {sim::Vector3d(1, 2, 3), 0.05, sim::Random(1, "process")};  // a tick each millisecond
}

TEST(GaussMarkov, AFarTimeIsReachedAtOnceAndHasTheSameValues) {
  sim::GaussMarkov stepped = process(), at_once = process();
  for (std::int64_t us = 0; us <= 200'000'000; us += 100'000) stepped.advance_to(Time{us});
  at_once.advance_to(Time{200'000'000});
  EXPECT_EQ(at_once.values(), stepped.values());
  at_once.advance_to(Time{std::int64_t{1} << 62});  // would take thousands of years tick by tick
  EXPECT_TRUE(at_once.values().allFinite());
}

}  // namespace
