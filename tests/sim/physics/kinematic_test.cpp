// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <ode/ode.h>

#include <cmath>
#include <numbers>

#include "sim/ode/ode_library.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;

constexpr double step_s = 0.01;

sim::Body& add_platform(PhysicsWorld& world, const Vector3d& size_m, const Pose& X_WB) {
  return add(world, body("platform", {box(size_m, 0)}), X_WB, Motion::kinematic);
}

TEST(KinematicBody, PushesAFreeBoxAtItsOwnSpeed) {
  const auto world = make_world({}, {slippery()});
  add_ground(*world);
  sim::Body& pusher = add_platform(*world, {1, 1, 1}, translation(0, 0, 0.6));
  const sim::Body& crate = add(*world, body("crate", {box({1, 1, 1}, 1000)}), translation(1.05, 0, 0.5));
  EXPECT_TRUE(pusher.kinematic());
  EXPECT_FALSE(pusher.fixed());
  EXPECT_EQ(pusher.mass_kg(), 0);
  for (int i = 0; i < 200; ++i) {
    pusher.move_to(translation(0.01 * (i + 1), 0, 0.6), step_s);
    world->step(i);
  }
  EXPECT_NEAR(pusher.X_WB().translation().x(), 2, 1e-12);
  EXPECT_NEAR(pusher.v_WB_W().x(), 1, 1e-9);
  EXPECT_NEAR(crate.v_WB_W().x(), 1, 0.02);
  EXPECT_NEAR(crate.X_WB().translation().x(), 3, 0.005);
}

TEST(KinematicBody, StandsStillWithoutACallAndIsNotPushed) {
  const auto world = make_world();
  sim::Body& shelf = add_platform(*world, {2, 2, 0.2}, sim::make_pose({0, 0, 1}, {0, 0, 0.7}));
  add(*world, body("crate", {box({1, 1, 1}, 1000)}), translation(0, 0, 1.6));
  const Eigen::Matrix4d before = shelf.X_WB().matrix();
  for (int i = 0; i < 1000; ++i) {
    shelf.add_force_W({1e6, 0, 0}, {0, 0, 1});
    world->step(i);
  }
  EXPECT_EQ(shelf.X_WB().matrix(), before);
  shelf.move_to(sim::make_pose({0.01, 0, 1}, {0, 0, 0.7}), step_s);
  world->step(1000);
  EXPECT_NEAR(shelf.v_WB_W().x(), 1, 1e-9);  // of the step that was
  world->step(1001);
  EXPECT_EQ(shelf.v_WB_W(), Vector3d(0, 0, 0));
  EXPECT_EQ(shelf.X_WB().translation(), Vector3d(0.01, 0, 1));
}

TEST(KinematicBody, CarriesABallAlongByFriction) {
  ContactConfig rolling;  // or the ball would roll backwards: 2/7 of the platform's acceleration is all it gets
  rolling.rolling_friction_m = 0.05;
  const auto world = make_world({}, {rolling});
  sim::Body& platform = add_platform(*world, {20, 2, 0.2}, Pose::Identity());
  const sim::Body& ball = add(*world, body("ball", {sphere(0.25, 1)}), translation(0, 0, 0.35));
  double x_m = 0;
  for (int i = 0; i < 500; ++i) {
    x_m += 0.2 * std::min(1.0, i / 100.0) * step_s;  // 0.2 m/s, reached in 1 s
    platform.move_to(translation(x_m, 0, 0), step_s);
    world->step(i);
  }
  EXPECT_NEAR(ball.v_WB_W().x(), 0.2, 0.005);
  EXPECT_NEAR(ball.X_WB().translation().x(), x_m, 0.02);
}

TEST(KinematicBody, IsWhereTheScriptSaysAfterTenThousandSteps) {
  const auto world = make_world();
  sim::Body& tram = add_platform(*world, {1, 1, 1}, translation(5, 0, 1));
  const auto script = [](int i) {
    const double angle = 2 * std::numbers::pi * i / 777;
    return sim::make_pose({5 * std::cos(angle), 5 * std::sin(angle), 1}, {0.1 * std::sin(3 * angle), 0, angle});
  };
  for (int i = 0; i < 10000; ++i) {
    tram.move_to(script(i + 1), step_s);
    world->step(i);
    if (i % 1000 == 999) {
      EXPECT_TRUE(tram.X_WB().matrix().isApprox(script(i + 1).matrix(), 1e-12)) << i;
    }
  }
  EXPECT_LT((tram.X_WB().matrix() - script(10000).matrix()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(tram.v_WB_W().norm(), 5 * 2 * std::numbers::pi / 777 / step_s, 1e-4);
}

TEST(KinematicBody, OdeItselfArrivesAtTheScriptedPose) {
  // What contacts see in the step: without it the seating after the step would hide a wrong velocity.  A hinge holds a
  // free body to the kinematic one; its error is that of the step.
  const auto world = make_world();
  const int group = world->add_group("ride");
  sim::Body& hub = world->add_body(group, body("hub", {box({1, 1, 1}, 0)}), Pose::Identity(), Motion::kinematic);
  sim::Body& arm = world->add_body(group, body("arm", {box({1, 1, 1}, 1)}, {2, 0, 0}), Pose::Identity());
  world->add_joint(group, joint("weld", JointType::fixed, {1, 0, 0}), hub, &arm, Pose::Identity());
  world->close_group(group);
  for (int i = 0; i < 300; ++i) {
    hub.move_to(sim::make_pose({0, 0, 0}, {0, 0, 0.005 * (i + 1)}), step_s);
    world->step(i);
  }
  EXPECT_NEAR(sim::yaw_of(arm.X_WB().linear()), 1.5, 1e-3);
  EXPECT_NEAR((arm.X_WB().translation() - 2 * Vector3d(std::cos(1.5), std::sin(1.5), 0)).norm(), 0, 0.01);
}

TEST(KinematicBody, TouchesNeitherFixedNorKinematicBodies) {
  const auto world = make_world();
  add_ground(*world);
  add(*world, body("wall", {box({1, 1, 1}, 0)}), translation(0, 0, 0), Motion::fixed);
  for (const double x : {0.2, 0.4}) add_platform(*world, {1, 1, 1}, translation(x, 0, 0));
  world->step(0);
  EXPECT_EQ(world->last_step().contacts, 0);
}

TEST(KinematicBody, IsSeenByRaysWhereItIs) {
  const auto world = make_world();
  sim::Body& door = add_platform(*world, {1, 9, 9}, translation(20, 0, 0));
  const auto range_m = [&] { return world->scene().cast({0, 0, 0}, {1, 0, 0}, 100, {})->range_m; };
  EXPECT_NEAR(range_m(), 19.5, 1e-12);
  door.move_to(translation(10, 0, 0), step_s);
  EXPECT_NEAR(range_m(), 19.5, 1e-12);
  world->step(0);
  EXPECT_NEAR(range_m(), 9.5, 1e-12);
  door.set_pose(translation(5, 0, 0));
  EXPECT_NEAR(range_m(), 4.5, 1e-12);
  world->step(1);
  EXPECT_NEAR(range_m(), 4.5, 1e-12);
}

TEST(KinematicBody, MakesOneIslandOfAllThatStandsOnIt) {
  // ODE walks over it from joint to joint: two spheres, a contact of 3 rows each.
  const auto world = make_world();
  add_platform(*world, {20, 20, 1}, Pose::Identity());
  for (const double x : {-3.0, 3.0})
    add(*world, body("ball" + std::to_string(x), {sphere(0.5, 1)}), translation(x, 0, 0.9999));
  world->step(0);
  EXPECT_EQ(world->last_step().contacts, 2);
  EXPECT_EQ(world->last_step().max_island_rows, 6);
}

TEST(KinematicBody, OdeWakesBodiesAcrossIt) {
  // The reason for the test above, read from ODE: the island of `a` is found from `b`.
  sim::start_ode();
  const sim::WorldHandle world(dWorldCreate());
  const dBodyID a = dBodyCreate(world.get()), middle = dBodyCreate(world.get()), b = dBodyCreate(world.get());
  dBodySetKinematic(middle);
  dJointAttach(dJointCreateBall(world.get(), nullptr), a, middle);
  dJointAttach(dJointCreateBall(world.get(), nullptr), middle, b);
  dBodyDisable(a);
  dWorldStep(world.get(), step_s);
  EXPECT_TRUE(dBodyIsEnabled(a));
}

TEST(KinematicBody, CannotCarryAPlaneAndCannotBeJoinedToTheWorld) {
  const auto world = make_world();
  const int group = world->add_group("rig");
  EXPECT_THROW(world->add_body(group, body("floor", {plane()}), Pose::Identity(), Motion::kinematic), sim::ConfigError);
  sim::Body& hub = world->add_body(group, body("hub", {box({1, 1, 1}, 0)}), Pose::Identity(), Motion::kinematic);
  EXPECT_THROW(world->add_joint(group, joint("weld", JointType::hinge, {0, 0, 0}), hub, nullptr, Pose::Identity()),
               sim::ConfigError);
}

TEST(KinematicBody, PoseThatIsNotFiniteIsAFault) {
  const auto world = make_world();
  sim::Body& hub = add_platform(*world, {1, 1, 1}, Pose::Identity());
  EXPECT_THROW(hub.move_to(translation(std::nan(""), 0, 0), step_s), sim::PhysicsFault);
}

}  // namespace
