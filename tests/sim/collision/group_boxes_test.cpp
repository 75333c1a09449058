// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/group_boxes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <vector>

namespace {

sim::AlignedBox cube(double x, double half = 1) {
  return {{x - half, -half, -half}, {x + half, half, half}};
}

TEST(GroupBoxes, AreFarWhenTheyMeetNoOthers) {
  sim::GroupBoxes groups;
  groups.clear(5);
  groups.set(0, cube(0));
  groups.set(1, cube(1.5));
  groups.set(2, cube(10));
  groups.set(4, cube(20));
  groups.find(std::vector{cube(20.5, 0.1)});
  EXPECT_FALSE(groups.far(0));
  EXPECT_FALSE(groups.far(1));
  EXPECT_TRUE(groups.far(2));
  EXPECT_FALSE(groups.far(3)) << "without a box";
  EXPECT_FALSE(groups.far(4)) << "at a fixed part";
  EXPECT_EQ(groups.count(), 1u);
}

TEST(GroupBoxes, AreNearToAnEndlessGround) {
  sim::GroupBoxes groups;
  groups.clear(2);
  groups.set(0, cube(0));
  groups.set(1, {{0, 0, 5}, {1, 1, 6}});
  constexpr double endless = std::numeric_limits<double>::infinity();
  groups.find(std::vector<sim::AlignedBox>{{{-endless, -endless, -endless}, {endless, endless, 0}}});
  EXPECT_FALSE(groups.far(0));
  EXPECT_TRUE(groups.far(1));
}

TEST(GroupBoxes, ComeNearWhenABoxMovesIntoTheirs) {
  sim::GroupBoxes groups;
  groups.clear(3);
  for (const int group : {0, 1, 2}) groups.set(group, cube(10 * group));
  groups.find({});
  EXPECT_EQ(groups.count(), 3u);
  std::set<int> near;
  groups.move(0, cube(9), [&](int group) { near.insert(group); });
  EXPECT_EQ(near, (std::set<int>{0, 1}));
  EXPECT_TRUE(groups.far(2));
  groups.remove(1);
  groups.move(3, cube(11), [&](int group) { near.insert(group); });
  EXPECT_EQ(near, (std::set<int>{0, 1, 3})) << "a new group meets the one at 9, not the removed one";
}

}  // namespace
