// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/physics/joint.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;

constexpr double damped_step_s = 0.01;
constexpr double cube_kg = 1, cube_kgm2 = cube_kg * 0.2 * 0.2 / 6;  // of the cube

JointConfig damped(JointType type, const Vector3d& axis, double damping) {
  JointConfig config = joint("j", type, {1, 0, 0}, axis);
  config.axis1.damping = damping;
  return config;
}

/// Speed after a push that gives `inertia` the speed 1 without damping, and `steps` in all: implicit Euler.
double damped_speed(double damping, double inertia, int steps) {
  return std::pow(1 + damping * damped_step_s / inertia, -steps);
}

TEST(JointDamping, SlowsEachKindOfJointByItsRate) {
  for (const double damping : {0.002, 0.2, 1000.0}) {
    CubePair hinge(damped(JointType::hinge, Vector3d::UnitY(), damping), true);
    hinge.joint->add_effort(cube_kgm2 / damped_step_s);
    hinge.run(1);
    EXPECT_NEAR(hinge.joint->velocity(), damped_speed(damping, cube_kgm2, 1), 1e-6);
    hinge.run(9);
    EXPECT_NEAR(hinge.joint->velocity(), damped_speed(damping, cube_kgm2, 10), 1e-6);

    CubePair slider(damped(JointType::slider, Vector3d::UnitZ(), damping), true);
    slider.joint->add_effort(cube_kg / damped_step_s);
    slider.run(10);
    EXPECT_NEAR(slider.joint->velocity(), damped_speed(damping, cube_kg, 10), 1e-6);

    JointConfig cardan = damped(JointType::universal, Vector3d::UnitY(), 0);
    cardan.axis2.axis = Vector3d::UnitZ();
    cardan.axis2.damping = damping;
    CubePair universal(cardan, true);
    universal.joint->add_effort(cube_kgm2 / damped_step_s, 1);
    universal.run(10);
    EXPECT_NEAR(universal.joint->velocity(1), damped_speed(damping, cube_kgm2, 10), 1e-6);
    EXPECT_NEAR(universal.joint->velocity(0), 0, 1e-6);

    JointConfig ball_config = damped(JointType::ball, Vector3d::UnitZ(), damping);
    ball_config.motor = true;
    CubePair ball(ball_config, true);
    ball.joint->add_effort(cube_kgm2 / damped_step_s, 2);
    ball.run(10);
    EXPECT_NEAR(ball.joint->velocity(2), damped_speed(damping, cube_kgm2, 10), 1e-6);
  }
}

TEST(JointDamping, OfASliderBesideTheCentersKeepsAllMomentum) {
  // The bodies are 1 m apart across the slider: a pair of forces at their centers would turn them.
  CubePair rig(damped(JointType::slider, Vector3d::UnitY(), 2), false);
  const auto spin = [&] {
    const auto of_cube = [](const sim::Body& cube, double mass) {
      return Vector3d(mass * cube.X_WB().translation().cross(cube.v_WB_W()) + mass * 0.04 / 6 * cube.w_WB_W());
    };
    return Vector3d(of_cube(*rig.base, 1000) + of_cube(*rig.arm, cube_kg));
  };
  rig.joint->add_effort(cube_kg / damped_step_s);
  rig.run(1);
  const Vector3d before = spin();
  const double velocity = rig.joint->velocity();
  rig.run(49);
  EXPECT_LT(rig.joint->velocity(), 0.5 * velocity);
  EXPECT_NEAR((1000 * rig.base->v_WB_W() + cube_kg * rig.arm->v_WB_W()).norm(), 0, 1e-6);
  EXPECT_NEAR((spin() - before).norm(), 0, 1e-3 * velocity);  // forces at the centers: 0.6 of it
}

TEST(JointDamping, IsNotPartOfTheEffortOfTheMotorThatWorksAgainstIt) {
  CubePair rig(damped(JointType::hinge, Vector3d::UnitY(), 0.5), true);
  rig.joint->measure_load();
  rig.joint->set_motor(2, 10);
  rig.run(10);
  EXPECT_NEAR(rig.joint->velocity(), 2, 1e-6);
  EXPECT_NEAR(rig.joint->effort(), 0.5 * 2, 1e-6);
  EXPECT_NEAR(rig.joint->torque_W_Nm().y(), 0, 1e-6);  // motor and damping: the speed is constant
  // A motor that is too weak stops where damping takes all of it.
  rig.joint->set_motor(2, 0.3);
  rig.run(100);
  EXPECT_NEAR(rig.joint->velocity(), 0.3 / 0.5, 1e-6);
}

TEST(JointDamping, IsPartOfTheForceOfASlider) {
  CubePair rig(damped(JointType::slider, Vector3d::UnitZ(), 0.5), true);
  rig.joint->measure_load();
  rig.joint->add_effort(cube_kg / damped_step_s);
  rig.run(1);
  // The effort gives the cube 1 m/s in a step, of which damping takes 0.5 N (m/s)^-1 times the speed at its end.
  const double speed_mps = damped_speed(0.5, cube_kg, 1);
  EXPECT_NEAR(rig.joint->velocity(), speed_mps, 1e-6);
  rig.run(1);  // without effort: damping alone
  EXPECT_NEAR(std::abs(rig.joint->force_W_N().z()), 0.5 * damped_speed(0.5, cube_kg, 2), 1e-6);
  EXPECT_NEAR(rig.joint->force_W_N().head<2>().norm(), 0, 1e-6);
}

TEST(JointDamping, CalmsAPendulum) {
  // theta'' = -c / I theta' - m g L / I theta: after a time t the amplitude is that at first times exp(-c t / 2 I).
  const double length_m = 1, damping = 0.2, inertia = cube_kg * (length_m * length_m + 0.4 * 0.01 * 0.01);
  PhysicsConfig physics;
  physics.step_s = 0.001;
  const auto world = make_world(physics);
  const int group = world->add_group("pendulum");
  const double start = 0.1;
  const sim::Body& bob = world->add_body(
      group, body("bob", {sphere(0.01, cube_kg)}, length_m * Vector3d(std::sin(start), 0, -std::cos(start))),
      Pose::Identity());
  JointConfig pivot = joint("pivot", JointType::hinge, {0, 0, 0}, Vector3d::UnitY());
  pivot.axis1.damping = damping;
  world->add_joint(group, pivot, const_cast<sim::Body&>(bob), nullptr, Pose::Identity());
  world->close_group(group);
  const double w = std::sqrt(9.80665 * cube_kg * length_m / inertia - std::pow(damping / (2 * inertia), 2));
  const int steps = static_cast<int>(std::lround(4 * 2 * std::numbers::pi / w / physics.step_s));  // four periods
  for (int i = 0; i < steps; ++i) world->step(i);
  const double expected = start * std::exp(-damping / (2 * inertia) * steps * physics.step_s);
  EXPECT_NEAR(bob.X_WB().translation().x(), length_m * std::sin(expected), 0.01 * expected);  // the step's error
}

}  // namespace
