// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/single_bodies.hpp"

#include <gtest/gtest.h>

#include "tests/sim/physics/step_objects.hpp"

namespace {

using namespace small_worlds;

/// Where the collision space has the part of a ball.
double part_x_m(const sim::SteppedBody& ball) {
  dReal sides[6];
  dGeomGetAABB(dBodyGetFirstGeom(ball.ode()), sides);
  return (sides[0] + sides[1]) / 2;
}

TEST(SingleBodies, AreSteppedWhenTheyHaveNoPairs) {
  StepObjects objects;
  const sim::SteppedBody& lone = objects.add_ball("lone", -50, 1);
  const sim::SteppedBody &a = objects.add_ball("a", 0, 1), &b = objects.add_ball("b", 0.9, 1);
  objects.deal();
  EXPECT_FALSE(objects.singles.step(nullptr));
  EXPECT_DOUBLE_EQ(lone.p_WC()[0], -49.99);
  EXPECT_EQ(a.p_WC()[0], 0) << "left to ODE";
  EXPECT_EQ(b.p_WC()[0], 0.9);
}

TEST(SingleBodies, LeaveStepsOfFirstOrderToOde) {
  StepObjects objects;
  sim::SteppedBody& ball = objects.add_ball("ball", 0, 1);
  ball.use_first_order();
  objects.deal();
  objects.singles.step(nullptr);
  EXPECT_EQ(ball.p_WC()[0], 0);
  EXPECT_TRUE(objects.shards.steps_by_ode(ball.group()));
}

TEST(SingleBodies, AreAheadOfTheirPartsUntilSomethingLooks) {
  StepObjects objects;
  const sim::SteppedBody& ball = objects.add_ball("ball", 0, 100);
  ASSERT_EQ(part_x_m(ball), 0);
  objects.deal();
  objects.singles.step(nullptr);
  EXPECT_EQ(part_x_m(ball), 0);
  objects.singles.bring_parts();
  EXPECT_DOUBLE_EQ(part_x_m(ball), 1);
}

TEST(SingleBodies, BringTheirPartsWhenTheyAreNoLongerSingle) {
  StepObjects objects;
  const sim::SteppedBody& ball = objects.add_ball("ball", 0, 100);
  objects.deal();
  objects.singles.step(nullptr);
  objects.add_body(ball.group(), body("second", {sphere(0.5, 1)}), translation(0, 5, 0));
  objects.singles.bring_parts();
  EXPECT_DOUBLE_EQ(part_x_m(ball), 1);
}

TEST(SingleBodies, AreMarkedBeforeTheSearchIfTheyAreNearSomething) {
  StepObjects objects;
  const sim::SteppedBody& far = objects.add_ball("far", 0, 100);
  const sim::SteppedBody& near = objects.add_ball("near", 500, 100);
  objects.add(body("wall", {box({1, 1, 1}, 0)}), translation(505, 0, 0), Motion::fixed);
  objects.far_groups.update();
  ASSERT_TRUE(objects.far_groups.far(far.group()));
  ASSERT_FALSE(objects.far_groups.far(near.group()));
  objects.deal();
  objects.singles.step(nullptr);
  objects.singles.mark_near();
  EXPECT_DOUBLE_EQ(part_x_m(near), 501);
  EXPECT_EQ(part_x_m(far), 0);
}

TEST(SingleBodies, OutOfBoundsAreSeen) {
  PhysicsConfig config = weightless();
  config.max_distance_m = 100;
  StepObjects objects(config);
  objects.add_ball("inside", 0);
  objects.deal();
  EXPECT_FALSE(objects.singles.step(nullptr));
  objects.add_ball("leaving", 99.5, 100);
  objects.deal();
  EXPECT_TRUE(objects.singles.step(nullptr));
}

}  // namespace
