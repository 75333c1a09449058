// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/pose_history.hpp"

#include <gmock/gmock.h>

#include <cstring>

namespace {

using viewer::PoseHistory;

sim::Bytes bodies(int value, std::size_t size = 20) {
  sim::Bytes bytes(size);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

int value_of(const std::optional<PoseHistory::State>& state) {
  int value = -1;
  if (state) std::memcpy(&value, state->bodies.data(), sizeof value);
  return value;
}

/// Adds states from a time on, ten per second; their values count from `first`.
void run(PoseHistory& history, std::int64_t from_us, int count, int first) {
  for (int i = 0; i < count; ++i) history.add(from_us + i * PoseHistory::interval_us, 1, bodies(first + i));
}

TEST(PoseHistory, ShowsTheLastStateAtOrBeforeATime) {
  PoseHistory history;
  EXPECT_FALSE(history.at(0, 0));
  run(history, 0, 10, 0);
  EXPECT_EQ(value_of(history.at(0, 499'999)), 4);
  EXPECT_EQ(value_of(history.at(0, 500'000)), 5);
  EXPECT_EQ(value_of(history.at(0, 99'000'000)), 9);
  EXPECT_EQ(value_of(history.at(0, -1)), 0) << "the first one";
  EXPECT_EQ(history.at(0, 500'000)->time_us, 500'000);
  EXPECT_FALSE(history.at(3, 0));
}

TEST(PoseHistory, KeepsTenStatesPerSimulatedSecondWhateverTheStep) {
  PoseHistory history;
  EXPECT_TRUE(history.is_due(0, 30'000));
  history.add(0, 1, bodies(0));
  int due = 0;
  for (std::int64_t time_us = 30'000; time_us <= 3'000'000; time_us += 30'000)
    if (history.is_due(time_us, 30'000)) ++due;
  EXPECT_EQ(due, 30);
}

TEST(PoseHistory, ABranchHasThePastOfTheBranchThatItLeft) {
  PoseHistory history;
  run(history, 0, 40, 0);
  history.start_branch(1, 1'050'000, 3'900'000, true);
  run(history, 1'100'000, 10, 100);
  EXPECT_EQ(value_of(history.at(1, 500'000)), 5);
  EXPECT_EQ(value_of(history.at(1, 1'099'999)), 10) << "not a later one of the branch before";
  EXPECT_EQ(value_of(history.at(1, 1'100'000)), 100);
  EXPECT_EQ(value_of(history.at(0, 2'000'000)), 20);
  const auto branches = history.branches();
  ASSERT_EQ(branches.size(), 2u);
  EXPECT_EQ(branches[1].parent, 0);
  EXPECT_EQ(branches[1].start_us, 1'050'000);
  EXPECT_EQ(branches[0].end_us, 3'900'000);
}

TEST(PoseHistory, FindsTheFirstTimeAtWhichBranchesDiffer) {
  PoseHistory history;
  run(history, 0, 40, 0);
  history.start_branch(1, 1'000'000, 3'900'000, true);
  run(history, 1'100'000, 10, 11);  // as before
  EXPECT_FALSE(history.first_difference(0, 1));
  history.add(2'100'000, 1, bodies(99));
  EXPECT_EQ(history.first_difference(0, 1), 2'100'000);
  // A grandchild that differs from its grandparent by its parent's states alone.
  history.start_branch(2, 2'500'000, 2'600'000, true);
  history.add(2'600'000, 1, bodies(26));
  EXPECT_EQ(history.first_difference(2, 0), 2'100'000);
  EXPECT_FALSE(history.first_difference(2, 1)) << "1 has no later states";
}

TEST(PoseHistory, AnotherPastAfterASnapshotFile) {
  PoseHistory history;
  run(history, 0, 20, 0);
  history.start_branch(1, 500'000, 1'900'000, false);
  run(history, 500'000, 5, 200);
  EXPECT_EQ(value_of(history.at(1, 100'000)), 200);
  EXPECT_EQ(history.first_difference(0, 1), 500'000);
}

TEST(PoseHistory, HalvesTheRateOfTheOlderHalfWhenItIsFull) {
  constexpr std::size_t max_bytes = 100'000;
  PoseHistory history(max_bytes);
  for (int i = 0; i < 10'000; ++i) {
    history.add(i * PoseHistory::interval_us, 1, bodies(i, 200));
    ASSERT_LE(history.bytes(), max_bytes);
  }
  EXPECT_GT(history.bytes(), max_bytes / 3) << "no more is removed than necessary";
  EXPECT_EQ(value_of(history.at(0, 0)), 0) << "the start is kept";
  // Recent times are as fine as they came, old ones are coarse.
  EXPECT_EQ(value_of(history.at(0, 9'990 * PoseHistory::interval_us)), 9'990);
  const auto middle = history.at(0, 5'000 * PoseHistory::interval_us);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(value_of(middle), 5'000, 200);
  EXPECT_EQ(middle->time_us, value_of(middle) * PoseHistory::interval_us);
}

TEST(PoseHistory, ManyBranchesAreBoundedToo) {
  PoseHistory history(50'000);
  for (int i = 1; i < 3'000; ++i) {
    history.start_branch(i, 1'000'000, 2'000'000, true);
    history.add(1'100'000, 1, bodies(i, 200));
    ASSERT_LE(history.bytes(), 50'000u);
    ASSERT_LE(history.branches().size(), PoseHistory::max_branches);
  }
  EXPECT_EQ(value_of(history.at(2'999, 1'100'000)), 2'999);
}

}  // namespace
