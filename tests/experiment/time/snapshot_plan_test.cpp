// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/time/snapshot_plan.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "experiment/results/run_error.hpp"

namespace {

using experiment::SnapshotPlan;
using testing::ElementsAre;

constexpr sim::Time ten_ms{10'000};

/// The steps up to one that are due in a run from `first`.
std::vector<std::int64_t> due(SnapshotPlan plan, std::int64_t first, std::int64_t last) {
  std::vector<std::int64_t> steps;
  for (std::int64_t step = first; step <= last; ++step)
    if (plan.take(step)) steps.push_back(step);
  return steps;
}

std::string refusal(double at_s) {
  try {
    SnapshotPlan({at_s}, {}, {ten_ms, 100, 3});
  } catch (const experiment::RunError& error) {
    return error.what();
  }
  return "none";
}

TEST(SnapshotPlan, TakesTheStepNearestToAGivenTime) {
  const SnapshotPlan plan({0.104, 0}, {}, {ten_ms, 0, 0});
  EXPECT_THAT(plan.next_steps(), ElementsAre(0, 10));
  EXPECT_THAT(due(plan, 0, 20), ElementsAre(0, 10));
}

TEST(SnapshotPlan, RefusesATimeThatTheRunDoesNotReach) {
  EXPECT_EQ(refusal(3.5), "--snapshot-at: 3.5 s is after the end of the run at 3 s");
  EXPECT_EQ(refusal(0.5), "--snapshot-at: 0.5 s is before the start of the run at 1 s");
  EXPECT_EQ(refusal(1), "none");
  EXPECT_EQ(refusal(3), "none");
}

TEST(SnapshotPlan, TakesEachIntervalOnceButNotTheStart) {
  EXPECT_THAT(due(SnapshotPlan({}, 0.05, {ten_ms, 0, 0}), 0, 16), ElementsAre(5, 10, 15));
  // Every other end of 2.5 steps lies halfway between two steps.
  EXPECT_EQ(due(SnapshotPlan({}, 0.025, {ten_ms, 0, 0}), 0, 1000).size(), 400u);
  // A run that continues at a multiple leaves it to the run before.
  const SnapshotPlan later({}, 0.05, {ten_ms, 10, 0});
  EXPECT_THAT(later.next_steps(), ElementsAre(15));
  EXPECT_THAT(due(later, 10, 21), ElementsAre(15, 20));
}

TEST(SnapshotPlan, KnowsWhichTimesAreStillMissing) {
  SnapshotPlan plan({0.1, 0.2}, {}, {ten_ms, 0, 0});
  for (std::int64_t step = 0; step <= 15; ++step) plan.take(step);
  EXPECT_THAT(plan.missing_s(), ElementsAre(testing::DoubleEq(0.2)));
}

}  // namespace
