// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <typename Action>
std::string fault_of(Action&& action) {
  try {
    action();
  } catch (const sim::PhysicsFault& fault) {
    return fault.what();
  }
  return "no fault";
}

TEST(Fault, ForceThatIsNotANumberNamesTheBody) {
  const auto world = make_world();
  sim::Body& hull = add(*world, body("hull", {sphere(1, 1)}), Pose::Identity());
  EXPECT_EQ(fault_of([&] {
              hull.add_force_W({0, nan, 0}, {0, 0, 0});
            }),
            "body 'hull/hull': a force on it is not finite");
  EXPECT_EQ(fault_of([&] {
              hull.add_force_W({0, 1, 0}, {nan, 0, 0});
            }),
            "body 'hull/hull': a force on it is not finite");
  EXPECT_EQ(fault_of([&] {
              hull.add_torque_W({0, 0, std::numeric_limits<double>::infinity()});
            }),
            "body 'hull/hull': a torque on it is not finite");
  EXPECT_EQ(fault_of([&] {
              hull.set_velocity_W({0, 0, nan}, {0, 0, 0});
            }),
            "body 'hull/hull': its new velocity is not finite");
  EXPECT_EQ(fault_of([&] { hull.set_pose(translation(0, 0, nan)); }), "body 'hull/hull': its new pose is not finite");
  world->step(0);  // nothing of it reached ODE
}

TEST(Fault, MotorThatIsNotANumberNamesTheJoint) {
  const auto world = make_world({}, {slippery()});
  Rover rover = add_rover(*world, "rover1", Pose::Identity());
  const std::string expected = "joint 'rover1/left': its motor's velocity or force is not a finite number";
  EXPECT_EQ(fault_of([&] { rover.left->set_motor(nan, 1); }), expected);
  EXPECT_EQ(fault_of([&] { rover.left->set_motor(1, nan); }), expected);
  EXPECT_EQ(fault_of([&] { rover.left->set_motor(1, -1); }), expected);
  EXPECT_EQ(fault_of([&] { rover.left->add_effort(nan); }), "joint 'rover1/left': an effort on it is not finite");
}

TEST(Fault, ExplosionNamesTheBodyTheSpeedAndTheStep) {
  const auto world = make_world();
  add(*world, body("calm", {sphere(1, 1)}), translation(9, 0, 0));
  sim::Body& rocket = add(*world, body("rocket", {sphere(1, 1)}), Pose::Identity());
  rocket.add_force_W({1.2e7, 0, 0}, {0, 0, 0});
  EXPECT_EQ(fault_of([&] { world->step(123); }),
            "body 'rocket/rocket': speed 1.2e+05 m/s is over 1000 m/s at step 123");
}

TEST(Fault, OverflowNamesTheBody) {
  const auto world = make_world();
  sim::Body& rocket = add(*world, body("rocket", {sphere(1, 1)}), Pose::Identity());
  rocket.add_force_W({1.7e308, 0, 0}, {0, 0, 0});
  rocket.add_force_W({1.7e308, 0, 0}, {0, 0, 0});
  EXPECT_EQ(fault_of([&] { world->step(4); }).substr(0, 22), "body 'rocket/rocket': ");
}

TEST(Fault, BodyThatFallsFromTheWorldIsNamed) {
  PhysicsConfig config;
  config.max_distance_m = 50;
  for (const auto& [word, space] : PhysicsConfig::space_words) {
    SCOPED_TRACE(std::string(word));
    config.space = space;
    const auto world = make_world(config);
    add(*world, body("stone", {sphere(1, 1)}), Pose::Identity());
    std::string fault = "no fault";
    int step = 0;
    for (; step < 1000 && fault == "no fault"; ++step) fault = fault_of([&] { world->step(step); });
    // 50 m take sqrt(2 50 / g) = 3.193 s; after 3.2 s it is at 50.2 m.
    EXPECT_NEAR(step, 320, 1);
    EXPECT_EQ(fault.substr(0, 51), "body 'stone/stone': distance 50.2 m from the origin") << fault;
  }
}

TEST(Fault, WorldCanBeDestroyedAfterOne) {
  auto world = make_world({}, {slippery()});
  add_ground(*world);
  Rover rover = add_rover(*world, "rover", Pose::Identity());
  world->step(0);
  rover.chassis->add_force_W({1e12, 0, 0}, {0, 0, 0});
  EXPECT_THROW(world->step(1), sim::PhysicsFault);
  world.reset();
}

TEST(Fault, FromInsideOdeIsAFaultToo) {
  PhysicsConfig config;
  config.gravity_mps2 = 1e300;  // overflows while ODE solves, and trips one of its asserts
  auto world = make_world(config);
  add_ground(*world);
  add(*world, body("stone", {box({1, 1, 1}, 1)}), sim::make_pose({0, 0, 0.5}, {0, 0, 0}));
  std::string fault = "no fault";
  for (int step = 0; step < 10 && fault == "no fault"; ++step) fault = fault_of([&] { world->step(step); });
  EXPECT_NE(fault, "no fault");
  world.reset();  // must not abort
}

}  // namespace
