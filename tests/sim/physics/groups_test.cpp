// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/groups.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Adds a fixed body, which needs no ODE world.
int add_body(sim::Groups& groups, int group) {
  static sim::SceneMoves moves;
  const int number = groups.next_body();
  groups.add_body(std::make_unique<sim::SteppedBody>("body", number, group, sim::Motion::fixed, moves));
  return number;
}

TEST(Groups, HaveTheNumbersOfTheirBodiesInTheOrderOfCreation) {
  sim::Groups groups;
  const int a = groups.add("a"), b = groups.add("b");
  EXPECT_EQ(add_body(groups, a), 0);
  EXPECT_EQ(add_body(groups, b), 1);
  EXPECT_EQ(add_body(groups, a), 2);
  EXPECT_THAT(groups[a].bodies, ElementsAre(0, 2));
  EXPECT_THAT(groups[b].bodies, ElementsAre(1));
  EXPECT_THAT(groups[a].moving, IsEmpty()) << "a fixed body does not move";
}

TEST(Groups, ReuseTheLowestNumbers) {
  sim::Groups groups;
  for (const int group : {groups.add("a"), groups.add("b"), groups.add("c")}) add_body(groups, group);
  for (const int removed : {1, 0}) {
    groups.destroy_bodies(groups[removed]);
    groups.remove(removed);
  }
  EXPECT_EQ(groups.bodies()[0], nullptr);
  EXPECT_EQ(groups.add("d"), 0);
  EXPECT_EQ(add_body(groups, 0), 0);
  EXPECT_EQ(groups.add("e"), 1);
}

TEST(Groups, TakePrescribedNumbersFirst) {
  sim::Groups groups;
  groups.prescribe({4, {7, 2}, {}, {}});
  EXPECT_FALSE(groups.as_prescribed());
  EXPECT_EQ(groups.add("a"), 4);
  EXPECT_EQ(add_body(groups, 4), 7);
  EXPECT_EQ(add_body(groups, 4), 2);
  EXPECT_TRUE(groups.as_prescribed());
  EXPECT_EQ(add_body(groups, 4), 0);
  EXPECT_THROW(groups.prescribe({5, {7}, {}, {}}), std::out_of_range) << "7 is in use";
}

TEST(Groups, AreNotFoundAfterTheirRemoval) {
  sim::Groups groups;
  const int a = groups.add("a");
  EXPECT_EQ(groups.at(a).name, "a");
  groups.remove(a);
  EXPECT_THROW(groups.at(a), std::out_of_range);
  EXPECT_THROW(groups.at(-1), std::out_of_range);
  EXPECT_EQ(groups.name(a), "");
  EXPECT_THROW(groups.name(1), std::out_of_range) << "never was a group";
}

}  // namespace
