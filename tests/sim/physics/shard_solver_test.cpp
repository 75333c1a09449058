// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/shard_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "tests/sim/physics/step_objects.hpp"

namespace {

using namespace small_worlds;

/// A shard with the bodies of one group of these objects.
sim::Shard shard_of(StepObjects& objects, int group) {
  sim::Shard shard;
  shard.groups = {group};
  shard.moving = objects.groups[group].moving;
  for (const int joint : objects.groups[group].joints) shard.joints.push_back(&objects.groups.joint(joint));
  return shard;
}

/// Steps the shard, whose bodies are in the ODE world of their group.
void step(StepObjects& objects, sim::Shard& shard, std::int64_t step_number = 1) {
  sim::ShardSolver solver(objects.settings, objects.groups, objects.collider, objects.islands, objects.moved);
  shard.world.reset(objects.shards.world_of(shard.groups.front()));
  objects.islands.begin_step();
  solver.step(shard, step_number);
  shard.world.release();
}

TEST(ShardSolver, StepsABodyWithoutContactsAlone) {
  StepObjects objects(with_step(0.01, 10));
  const sim::SteppedBody& ball = objects.add_ball("ball", 0, 2);
  sim::Shard shard = shard_of(objects, ball.group());
  step(objects, shard);
  EXPECT_TRUE(ball.alone());
  EXPECT_DOUBLE_EQ(ball.p_WC()[0], 0.02);
  // A step of second order: h^2 g / 2; one of ODE would fall by h^2 g.
  EXPECT_NEAR(ball.p_WC()[2], -0.0005, 1e-15);
  EXPECT_EQ(shard.max_rows, 0);
}

TEST(ShardSolver, LeavesABodyWithAContactToOde) {
  StepObjects objects;
  const sim::SteppedBody& ball = objects.add_ball("ball", 0, 0);
  const sim::SteppedBody& wall = objects.add(body("wall", {box({1, 1, 1}, 0)}), translation(0.9, 0, 0), Motion::fixed);
  sim::Shard shard = shard_of(objects, ball.group());
  shard.pairs = objects.collider.find_pairs();
  ASSERT_EQ(shard.pairs.size(), 1u);
  objects.collider.watch(wall.group());
  step(objects, shard);
  EXPECT_FALSE(ball.alone());
  EXPECT_EQ(shard.contact_count, 1);
  ASSERT_EQ(shard.contacts.size(), 1u) << "the wall is watched";
  EXPECT_LT(shard.contacts[0].force_W_N.x(), 0) << "on the ball, which has the lower part";
  EXPECT_LT(ball.v_WC_W()[0], 0);
}

TEST(ShardSolver, UsesQuickStepForIslandsWithTooManyRows) {
  for (const int limit : {2, 3}) {
    PhysicsConfig config = weightless();
    config.quick_above_rows = limit;
    StepObjects objects(config);
    // A contact with friction has three rows.
    const sim::SteppedBody& ball = objects.add_ball("ball", 0, 0);
    objects.add(body("wall", {box({1, 1, 1}, 0)}), translation(0.9, 0, 0), Motion::fixed);
    sim::Shard shard = shard_of(objects, ball.group());
    shard.pairs = objects.collider.find_pairs();
    step(objects, shard);
    EXPECT_EQ(shard.max_rows, 3);
    EXPECT_EQ(shard.quick, limit == 2);
    EXPECT_EQ(shard.quick_instead, limit == 2);
  }
}

TEST(ShardSolver, BringsKinematicBodiesToTheirPosesAndJointsToTheirPositions) {
  StepObjects objects;
  const int group = objects.add_group("rig");
  sim::SteppedBody& base =
      objects.add_body(group, body("base", {box({1, 1, 1}, 0)}), Pose::Identity(), Motion::kinematic);
  sim::SteppedBody& arm = objects.add_body(group, body("arm", {box({1, 1, 1}, 1)}), translation(2, 0, 0));
  sim::SteppedJoint& hinge = objects.add_joint(group, joint("hinge", JointType::hinge, {2, 0, 0}), base, &arm);
  objects.close(group);
  base.move_to(translation(0, 0.01, 0), 0.01);
  arm.set_velocity_W({0, 1, 0}, {0, 0, 3});
  sim::Shard shard = shard_of(objects, group);
  step(objects, shard);
  EXPECT_EQ(base.X_WB().matrix(), translation(0, 0.01, 0).matrix());
  // ODE turns by 2 atan(w h / 2) at w = 3 rad/s and h = 10 ms.
  EXPECT_NEAR(hinge.position(), 2 * std::atan(0.015), 1e-9);
  EXPECT_FALSE(shard.out_of_bounds);
}

TEST(ShardSolver, SeesBodiesOutOfBounds) {
  PhysicsConfig config = weightless();
  config.max_distance_m = 100;
  StepObjects objects(config);
  const sim::SteppedBody& ball = objects.add_ball("ball", 99, 150);
  sim::Shard shard = shard_of(objects, ball.group());
  step(objects, shard);
  EXPECT_TRUE(shard.out_of_bounds) << "at 100.5 m";
  EXPECT_EQ(shard.fault, nullptr) << "ODE did not fail";
}

}  // namespace
