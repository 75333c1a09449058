// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/memory.hpp"

#include <gtest/gtest.h>

#include "autonomy/behaviors/helm_behavior.hpp"
#include "autonomy/missions/marine/coop_auv.hpp"

namespace {

using autonomy::Memory;

TEST(Memory, PutsBackWhatWasKnownAfterTheLastDecisionBefore) {
  int state = 0;
  Memory memory(state, 60);
  for (std::int64_t tick = 1; tick <= 10; ++tick) {
    state = static_cast<int>(tick);
    memory.keep(tick * 100'000);
  }
  EXPECT_TRUE(memory.rewind(450'000));
  EXPECT_EQ(state, 4);
  EXPECT_TRUE(memory.rewind(400'000));  // the decision at that tick is still to be made
  EXPECT_EQ(state, 3);
  state = 40;
  memory.keep(400'000);
  state = 50;
  memory.keep(500'000);
  EXPECT_TRUE(memory.rewind(500'000));
  EXPECT_EQ(state, 40) << "of the new branch, not of the one that was left";
  EXPECT_TRUE(memory.rewind(50'000));
  EXPECT_EQ(state, 0) << "before its first decision";
}

TEST(Memory, KeepsAsLongAsItIsConfiguredAndNoLonger) {
  int state = 0;
  Memory memory(state, 2);
  for (std::int64_t tick = 1; tick <= 1000; ++tick) {
    state = static_cast<int>(tick);
    memory.keep(tick * 10'000);
  }
  // At 10 s: from the one that holds at 8 s on.
  EXPECT_EQ(memory.size(), 201u);
  EXPECT_FALSE(memory.rewind(8'000'000));
  EXPECT_EQ(state, 1000) << "left alone";
  EXPECT_TRUE(memory.rewind(8'000'001));
  EXPECT_EQ(state, 800);
}

TEST(Memory, OfNoLengthKeepsNothing) {
  int state = 7;
  Memory memory(state, 0);
  memory.keep(1);
  EXPECT_EQ(memory.size(), 0u);
  EXPECT_FALSE(memory.rewind(2));
  EXPECT_EQ(state, 7);
}

TEST(Memory, ABehaviorIsCopiedWithItsOwner) {
  // A route of two legs: the copy stays where it was while the other continues.
  autonomy::Cloned<autonomy::HelmBehavior> behavior = std::make_unique<autonomy::RouteBehavior>(
      std::vector<autonomy::Vector2d>{{100, 0}, {100, 100}}, autonomy::RouteBehavior::Params{});
  behavior->steer({0, {0, 0}, {1, 0}});
  Memory memory(behavior, 60);
  const double east = behavior->steer({0, {50, 0}, {1, 0}}).heading_rad;
  memory.keep(1);
  const double north = behavior->steer({0, {100, 0}, {1, 0}}).heading_rad;
  memory.keep(2);
  EXPECT_NE(east, north);
  EXPECT_EQ(behavior->steer({0, {50, 0}, {1, 0}}).heading_rad > 0.1, true) << "on its way to the second waypoint";
  ASSERT_TRUE(memory.rewind(2));
  EXPECT_EQ(behavior->steer({0, {50, 0}, {1, 0}}).heading_rad, east);
}

}  // namespace
