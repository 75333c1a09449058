// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/shards.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sim/physics/step_objects.hpp"

namespace {

using namespace small_worlds;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(Shards, GiveEachGroupAWorldOfItsOwn) {
  StepObjects objects;
  const sim::SteppedBody &a = objects.add_ball("a", 0), &b = objects.add_ball("b", 10);
  EXPECT_NE(dBodyGetWorld(a.ode()), dBodyGetWorld(b.ode()));
  EXPECT_EQ(objects.groups[a.group()].shard, a.group());
  objects.add(body("ground", {plane()}), translation(0, 0, -10), Motion::fixed);
  EXPECT_EQ(objects.groups[2].shard, -1) << "without moving bodies";
}

TEST(Shards, BringGroupsWithPairsIntoTheWorldOfTheLowestNumber) {
  StepObjects objects;
  objects.add_ball("far", -50);
  const sim::SteppedBody &a = objects.add_ball("a", 0), &b = objects.add_ball("b", 0.9),
                         &c = objects.add_ball("c", 1.8);
  objects.deal();
  EXPECT_EQ(objects.groups[0].shard, 0);
  for (const sim::SteppedBody* each : {&a, &b, &c}) EXPECT_EQ(objects.groups[each->group()].shard, 1) << each->name();
  EXPECT_EQ(dBodyGetWorld(c.ode()), dBodyGetWorld(a.ode()));
  EXPECT_THAT(objects.shards[1].groups, ElementsAre(1, 2, 3));
  EXPECT_THAT(objects.shards.singles(), ElementsAre(0)) << "the other one holds three bodies";
  EXPECT_TRUE(objects.shards.steps_by_ode(1));
  EXPECT_FALSE(objects.shards.steps_by_ode(0));
  EXPECT_EQ(objects.shards[1].pairs.size(), 2u) << "a and b, b and c";
}

TEST(Shards, AreSeparatedInEvery128thStep) {
  StepObjects objects;
  objects.add_ball("a", 0);
  sim::SteppedBody& b = objects.add_ball("b", 0.9);
  objects.deal(1);
  ASSERT_EQ(objects.groups[1].shard, 0);
  b.set_pose(translation(10, 0, 0));
  objects.deal(127);
  EXPECT_EQ(objects.groups[1].shard, 0);
  objects.deal(128);
  EXPECT_EQ(objects.groups[1].shard, 1);
  EXPECT_THAT(objects.shards.singles(), ElementsAre(0, 1));
}

TEST(Shards, KeepTheirGroupsInTheOrderOfTheirNumbers) {
  StepObjects objects;
  objects.add_ball("a", 0);
  sim::SteppedBody& b = objects.add_ball("b", 20);
  objects.add_ball("c", 0.9);
  objects.deal(1);
  ASSERT_THAT(objects.shards[0].groups, ElementsAre(0, 2));
  b.set_pose(translation(1.8, 0, 0));
  objects.deal(2);
  EXPECT_THAT(objects.shards[0].groups, ElementsAre(0, 1, 2)) << "the third was created again, after the second";
  EXPECT_THAT(objects.shards[0].moving, ElementsAre(&objects.groups.body(0), &b, &objects.groups.body(2)));
}

TEST(Shards, MoveToTheNextGroupWhenTheirFirstOneLeaves) {
  StepObjects objects;
  for (const double x_m : {0.0, 0.9, 1.8}) objects.add_ball("ball", x_m);
  objects.deal();
  objects.shards.leave(0);
  EXPECT_EQ(objects.groups[0].shard, -1);
  for (const int left : {1, 2}) EXPECT_EQ(objects.groups[left].shard, 1);
  EXPECT_THAT(objects.shards[0].groups, IsEmpty());
  EXPECT_THAT(objects.shards[1].groups, ElementsAre(1, 2));
  EXPECT_FALSE(objects.shards.listed());
}

TEST(Shards, AreSteppedByOdeWithPairsOrWhenTheyAreToldTo) {
  StepObjects objects;
  objects.add_ball("lone", -50);
  const sim::SteppedBody& told = objects.add_ball("told", -20);
  objects.add_ball("a", 0);
  objects.add_ball("b", 0.9);
  objects.deal();
  objects.shards.step_by_ode(told.group());
  EXPECT_FALSE(objects.shards.step(nullptr, 1)) << "none is out of bounds";
  EXPECT_THAT(objects.shards.stepped(), ElementsAre(&objects.shards[1], &objects.shards[2]));
  EXPECT_EQ(objects.shards[1].contact_count, 0);
  EXPECT_GT(objects.shards[2].contact_count, 0);
}

TEST(Shards, GiveAllWorldsTheGravityOfTheSettings) {
  StepObjects objects;
  const sim::SteppedBody& before = objects.add_ball("before", 0);
  objects.settings.gravity_mps2 = 3;
  objects.shards.set_gravity();
  const sim::SteppedBody& after = objects.add_ball("after", 10);
  for (const sim::SteppedBody* each : {&before, &after}) {
    dVector3 gravity;
    dWorldGetGravity(dBodyGetWorld(each->ode()), gravity);
    EXPECT_EQ(gravity[2], -3) << each->name();
  }
}

}  // namespace
