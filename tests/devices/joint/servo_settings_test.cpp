// SPDX-License-Identifier: BSD-3-Clause
// Deadband and resolution of a joint servo, and the state of all that its gear has.

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "devices/joint/joint_servo.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "tests/devices/joint/servo_fixture.hpp"
#include "tests/devices/state_fixture.hpp"

namespace {

using test::ServoRig;

TEST(JointServo, ReturnsToTheEdgeOfItsDeadband) {
  for (const double side : {1.0, -1.0}) {
    ServoRig rig({.keys = ", deadband: 0.02, max_effort: 1"});
    rig.load(side * 1.2);
    rig.run_for(0.3);
    ASSERT_GT(std::abs(rig.position()), 0.1);
    rig.load(0);
    rig.run_for(5);  // 100 times 1 / kp
    EXPECT_NEAR(rig.position(), -side * 0.02, 1e-5);
  }
}

TEST(JointServo, AtRestItsErrorIsWithinItsDeadband) {
  for (const std::string& control : {test::velocity_control, test::pid_control})
    for (double target = -1; target < 1.01; target += 0.1) {
      ServoRig rig({.keys = ", deadband: 0.02, max_velocity: 5" + control});
      rig.command(0, target);
      rig.run_for(2);
      EXPECT_LE(std::abs(rig.position() - target), 0.02 + 1e-5) << control << target;
    }
}

TEST(JointServo, RestsOnlyAtMultiplesOfItsQuantum) {
  ServoRig rig({.keys = ", command_quantum: 0.05, max_velocity: 20"});
  std::set<long> places;
  for (int i = 0; i <= 100; ++i) {
    rig.command(0, 0.01 * i + 0.001);
    rig.run_for(0.5);
    const long place = std::lround((0.01 * i + 0.001) / 0.05);
    places.insert(place);
    EXPECT_NEAR(rig.position(), 0.05 * static_cast<double>(place), 1e-5) << i;
  }
  EXPECT_EQ(places.size(), 21U);
}

TEST(JointServo, HoldsBetweenMultiplesOfItsQuantum) {
  ServoRig rig({.keys = ", command_quantum: 0.5, max_velocity: 1, watchdog_s: 0.2, safe: hold"});
  rig.command(1, 1);
  rig.run_for(1);
  EXPECT_NEAR(rig.position(), 0.2, 0.002);  // stale after 0.2 s
}

const std::string all_keys =
    ", max_effort: 3, max_velocity: 8, max_acceleration: 40, deadband: 0.01, command_quantum: 0.02, stall_effort: 2, "
    "no_load_velocity: 6, friction: 0.1, play: 0.05, overload: {share: 0.4, window_s: 0.3}";

/// Commands of all modes under changing loads: the overload protection acts, and a reset follows.
void drive(test::TappedWorld& world, int step) {
  if (step % 90 == 0)
    world.send("v1.servo.cmd", shoal::joint_servo_command_t{0, static_cast<std::int8_t>(step / 90 % 5), 0.7, -5, 0.9});
  shoal::wrench_t wrench{};
  wrench.torque_Nm[2] = 1.5 * std::sin(0.01 * step);
  if (step % 10 == 0) world.send("v1.load.cmd", wrench);
}

TEST(JointServo, WithAllOfItsGearContinuesAlikeAfterASnapshot) {
  for (const std::string& control : {test::velocity_control, test::pid_control}) {
    test::SavedRun run(ServoRig::yaml({.keys = all_keys + control,
                                       .devices = "        - {name: state, type: joint_state, rate_hz: 83}\n"
                                                  "        - {name: battery, type: battery, rate_hz: 90}\n"}),
                       drive);
    run.expect_restored_worlds_go_on_alike({0, 60, 200, 333, 450, 530, 801}, 300);
  }
}

TEST(JointServo, WithoutItsGearHasTheSameHashAsBefore) {
  // Zeros are the defaults.
  const auto hash = [](const std::string& keys) {
    ServoRig rig({.keys = keys});
    rig.load(0.1);
    rig.command(0, 1);
    rig.run_for(0.5);
    return rig.world.state().hash();
  };
  EXPECT_EQ(hash(""), hash(", play: 0, friction: 0, deadband: 0, command_quantum: 0"));
  EXPECT_NE(hash(""), hash(", friction: 0.01"));
}

TEST(JointServo, ItsGearCanChangeWhileItRuns) {
  ServoRig rig({.keys = ", max_effort: 5, max_velocity: 20"});
  rig.command(1, 20);
  rig.load(0.5);
  rig.run_for(0.5);
  EXPECT_NEAR(rig.velocity(), 20, 1e-4);
  ASSERT_EQ(rig.change("v1/servo", "{stall_effort: 1, no_load_velocity: 6, play: 0.1}"), "");
  rig.run_for(2);
  EXPECT_NEAR(rig.velocity(), 3, 1e-4);
  ASSERT_EQ(rig.change("v1/servo", "{play: 0, friction: 0.25}"), "");
  rig.run_for(2);
  EXPECT_NEAR(rig.velocity(), 1.5, 1e-4);
  // The motor side starts where the joint is: free travel of half of the play, and no more.
  ASSERT_EQ(rig.change("v1/servo", "{play: 0.1}"), "");
  rig.command(3);
  rig.run_for(0.001);
  rig.command(1, 0);
  rig.load(0.3);
  rig.run_for(2);
  const double lower = rig.position();
  rig.load(-0.3);
  rig.run_for(2);
  EXPECT_NEAR(rig.position() - lower, 0.1, 1e-4);
}

TEST(JointServo, ItsAliasIsAnyText) {
  ServoRig rig({.keys = ", alias: 'PRM:/r2/c1-Joint2:21'"});
  const auto& servo =
      dynamic_cast<const devices::JointServo&>(*rig.world.find_vehicle("v1")->find_device("servo")->actuator());
  EXPECT_EQ(servo.alias(), "PRM:/r2/c1-Joint2:21");
}

}  // namespace
