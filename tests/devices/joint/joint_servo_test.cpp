// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/joint_servo.hpp"

#include <gmock/gmock.h>

#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/joint/arm_fixture.hpp"
#include "tests/devices/joint/joint_servo_fixture.hpp"

namespace {

using namespace joint_servo_fixture;

TEST(JointServo, HoldsWhereItStartsUntilItIsTold) {
  test::TestWorld test(test::arm_world(servo(", max_effort: 50")));
  test.run_for(1);
  EXPECT_NEAR(shoulder(test).position(), 0, 1e-6);  // the motor's softness, cfm 1e-9
}

TEST(JointServo, MovesAtExactlyItsLimitsAndStopsAtItsTarget) {
  test::TestWorld test(test::arm_world(servo(", max_velocity: 0.5, max_acceleration: 1, max_effort: 100")));
  command(test, 0, 1);
  std::vector<double> velocities;
  for (int i = 0; i < 3000; ++i) {
    test.world.step();
    velocities.push_back(shoulder(test).velocity());
  }
  // The trapezoid 0.5 s up, 1.5 s at 0.5 rad/s, 0.5 s down.  Step n (from 1) of the ramp is at n * 1 ms * 1 rad/s^2;
  // 1e-4 for the motor's softness and the error that it then takes back.
  for (std::size_t n = 1; n <= 500; ++n) ASSERT_NEAR(velocities[n - 1], 0.001 * static_cast<double>(n), 1e-4) << n;
  for (std::size_t n = 501; n <= 1990; ++n) ASSERT_NEAR(velocities[n - 1], 0.5, 1e-4) << n;
  EXPECT_NEAR(velocities[2250 - 1], 0.25, 1e-2);  // half way down, except for the rounding to whole steps
  EXPECT_NEAR(velocities[2510], 0, 1e-3);
  EXPECT_NEAR(shoulder(test).position(), 1, 1e-5);
}

TEST(JointServo, PidEndsWhereItsSpringCarriesTheArm) {
  test::TestWorld test(test::arm_world(servo(", control: pid, kp: 200, kd: 20, max_effort: 50, max_velocity: 2")));
  command(test, 0, 0.5);
  test.run_for(6);
  // kp (0.5 - q) = -m g l cos(q), by fixed point.
  double q = 0.5;
  for (int i = 0; i < 50; ++i) q = 0.5 + test::arm_mass_kg * 9.80665 * test::arm_length_m * std::cos(q) / 200;
  EXPECT_NEAR(shoulder(test).position(), q, 1e-6);  // a time constant of kd / kp = 0.1 s
}

TEST(JointServo, PidWithAnIntegralEndsAtItsTarget) {
  test::TestWorld test(test::arm_world(
      servo(", control: pid, kp: 200, ki: 400, kd: 20, integral_limit: 20, max_effort: 50, max_velocity: 2")));
  command(test, 0, 0.5);
  test.run_for(12);  // kp / ki = 0.5 s
  EXPECT_NEAR(shoulder(test).position(), 0.5, 1e-6);
}

TEST(JointServo, PidKeepsACommandedVelocity) {
  test::TestWorld test(test::arm_world(servo(", control: pid, kp: 200, kd: 20, max_effort: 50"), 0));
  command(test, 1, 0.4);
  test.run_for(2);
  EXPECT_NEAR(shoulder(test).velocity(), 0.4, 1e-6);
}

TEST(JointServo, EffortAcceleratesTheArmByItsInertia) {
  test::TestWorld test(test::arm_world(servo(", max_velocity: 10"), 0));
  command(test, 2, 3);
  test.run_for(0.5);
  const double acceleration = 3 / test::arm_inertia_kgm2;
  // 1e-4: in each step the ball leaves its circle along the tangent, by up to w dt = 0.003 rad, and is pulled back.
  EXPECT_NEAR(shoulder(test).velocity(), acceleration * 0.5, 1e-4 * acceleration);
  // Semi-implicit Euler: a t (t + dt) / 2.
  EXPECT_NEAR(shoulder(test).position(), acceleration * 0.5 * 0.501 / 2, 1e-4);
}

TEST(JointServo, EffortPushesNoFasterThanTheVelocityLimit) {
  test::TestWorld test(test::arm_world(servo(", max_velocity: 0.5"), 0));
  command(test, 2, 3);
  test.run_for(2);
  const double one_step = 3 / test::arm_inertia_kgm2 * 0.001;
  EXPECT_GE(shoulder(test).velocity(), 0.5 - 1e-6);
  EXPECT_LE(shoulder(test).velocity(), 0.5 + one_step);
}

TEST(JointServo, GoesNoFartherThanItsRange) {
  test::TestWorld test(test::arm_world(servo(", low: -0.2, max_effort: 50"), 9.80665, ", high_stop: 0.3"));
  command(test, 0, 1);
  test.run_for(2);
  EXPECT_NEAR(shoulder(test).position(), 0.3, 1e-4);  // of the joint's stop
  command(test, 1, -1);
  test.run_for(2);
  EXPECT_NEAR(shoulder(test).position(), -0.2, 1e-4);  // its own
}

TEST(JointServo, TheVelocityLoopIsStableAtAnyGain) {
  test::TestWorld test(test::arm_world(servo(", kp: 1e6, max_effort: 100, max_acceleration: 2")));
  command(test, 0, 0.5);
  test.run_for(3);
  EXPECT_NEAR(shoulder(test).position(), 0.5, 1e-5);
  EXPECT_NEAR(shoulder(test).velocity(), 0, 1e-4);
}

TEST(JointServo, ItsRangeCanShrinkWhileItRuns) {
  test::TestWorld test(test::arm_world(servo(", max_effort: 50")));
  command(test, 0, 0.8);
  test.run_for(1.5);
  EXPECT_NEAR(shoulder(test).position(), 0.8, 1e-4);
  sim::Diagnostics diagnostics;
  const auto values = sim::parse_config_text("{high: 0.2, max_velocity: 2}", "change", diagnostics);
  ASSERT_TRUE(test.world.editor().change_device("a1/servo", values, diagnostics));
  test.run_for(0.15);
  EXPECT_NEAR(shoulder(test).velocity(), -2, 0.01);
  test.run_for(0.5);
  EXPECT_NEAR(shoulder(test).position(), 0.2, 1e-4);
}

TEST(JointServo, ItsRangeMustMeetTheStopsOfItsJoint) {
  const auto error_of = [](const std::string& keys) {
    return test::error_of_world(test::arm_world(servo(keys), 9.80665, ", low_stop: -0.4, high_stop: 0.3"));
  };
  EXPECT_THAT(error_of(", low: 0.5"), testing::HasSubstr("device 'servo': 'low' is outside the joint's stops: 0.5 is "
                                                         "above 'high_stop', 0.3"));
  EXPECT_THAT(error_of(", high: -0.5"), testing::HasSubstr("device 'servo': 'high' is outside the joint's stops: -0.5 "
                                                           "is below 'low_stop', -0.4"));
  EXPECT_EQ(error_of(", low: -1, high: 1"), "");
  EXPECT_EQ(error_of(", low: 0.3"), "");
}

TEST(JointServo, AChangeOfItsRangeDoesNotReachBeyondTheStops) {
  test::TestWorld test(test::arm_world(servo(""), 9.80665, ", high_stop: 0.3"));
  ASSERT_EQ(test.change("a1/servo", "{low: 0.5}"), "");
  const auto& device = *test.world.find_vehicle("a1")->find_device("servo")->actuator();
  EXPECT_EQ(dynamic_cast<const devices::JointServo&>(device).low(), 0.3);
  EXPECT_EQ(dynamic_cast<const devices::JointServo&>(device).high(), 0.3);
}

TEST(JointServo, TooWeakForTheArmItSinks) {
  // The arm asks for 9.8 N m, the servo has 9 N m of it, and the arm's moment falls below that at 23 degrees.
  test::TestWorld test(test::arm_world(servo(", max_effort: 9")));
  test.run_for(0.5);
  const double acceleration = (9.80665 - 9) / test::arm_inertia_kgm2;
  EXPECT_NEAR(shoulder(test).position(), acceleration * 0.5 * 0.5 / 2, 0.01 * acceleration);  // level: cos(0.2) = 0.98
}

TEST(JointServo, WithoutEffectivenessItGivesNoForceAtAll) {
  const auto fall = [](const std::string& devices, bool dead) {
    test::TestWorld test(test::arm_world(devices));
    if (dead) test.world.editor().set_fault("a1/servo", {.kind = sim::FaultKind::dead});
    test.run_for(0.3);
    return shoulder(test).position();
  };
  const double free_fall = fall("        - {name: dummy, type: joint_state}\n", false);
  EXPECT_GT(free_fall, 0.3);
  EXPECT_EQ(fall(servo(""), true), free_fall);
  EXPECT_EQ(fall(servo(", control: pid"), true), free_fall);
}

TEST(JointServo, PartlyDeadItsLargestEffortIsTheShare) {
  test::TestWorld test(test::arm_world(servo(", max_velocity: 10"), 0));
  test.world.editor().set_fault("a1/servo", {.kind = sim::FaultKind::partial, .effectiveness = 0.25});
  command(test, 2, 10);
  test.run_for(0.1);
  EXPECT_NEAR(shoulder(test).velocity(), 2.5 / test::arm_inertia_kgm2 * 0.1, 1e-6);
}

TEST(JointServo, AfterAFaultItStartsFromWhereTheJointIs) {
  test::TestWorld test(test::arm_world(servo(", max_velocity: 0.5, max_effort: 2000")));
  test.world.editor().set_fault("a1/servo", {.kind = sim::FaultKind::dead});
  test.run_for(0.4);
  const double fallen = shoulder(test).position();
  ASSERT_GT(fallen, 0.5);
  test.world.editor().clear_faults("a1/servo");
  test.run_for(0.5);
  EXPECT_NEAR(shoulder(test).position(), fallen - 0.25,
              0.02);  // back at 0.5 rad/s, not with a jump; it falls on while it brakes
}

TEST(JointServo, GoesToItsSafeStateWhenCommandsStopComing) {
  const auto end = [](const std::string& safe) {
    test::TestWorld test(test::arm_world(
        servo(", max_effort: 50, watchdog_s: 0.2, park_position: -0.5, max_acceleration: 2, safe: " + safe)));
    command(test, 1, 0.5);
    test.run_for(3);
    return shoulder(test).position();
  };
  // 0.25 s up to 0.5 rad/s are not over after 0.201 s: then at 0.402 rad/s after 0.0404 rad.
  const double distance = 0.201 * 0.202;
  EXPECT_NEAR(end("hold"), distance, 2e-3);
  EXPECT_NEAR(end("stop"), distance + 0.402 * 0.402 / 4, 2e-3);
  EXPECT_NEAR(end("park"), -0.5, 1e-5);
  EXPECT_GT(std::abs(end("coast")), 0.5);  // it swings
}

TEST(JointServo, TakesThePowerOfItsMotionAndItsHeat) {
  // Raising the arm at 0.2 rad/s: moment * 0.2 rad/s / 0.5, and 4 W times the square of the moment over 19.6133 N m.
  test::TestWorld test(test::arm_world(servo(", max_effort: 19.6133, efficiency: 0.5, holding_W: 4") +
                                       "        - {name: battery, type: battery}\n"));
  command(test, 1, -0.2);
  test.run_for(0.8);
  const auto* device = test.world.find_vehicle("a1")->find_device("servo")->actuator();
  const double moment_Nm = 9.80665 * std::cos(shoulder(test).position());
  EXPECT_NEAR(device->power_W(), moment_Nm * 0.2 / 0.5 + 4 * std::pow(moment_Nm / 19.6133, 2), 0.005);
}

TEST(JointServo, SaysWhatIsWrongWithItsParameters) {
  const auto error_of = [](const std::string& keys) -> std::string {
    try {
      test::TestWorld test(test::arm_world(servo(keys)));
      return "";
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(error_of(", low: 1, high: -1"), testing::HasSubstr("device 'servo': 'low' must not be above 'high'"));
  EXPECT_THAT(error_of(", axis: 1"),
              testing::HasSubstr("device 'servo': joint 'shoulder' is a hinge and has no axis 1"));
  EXPECT_THAT(error_of(", max_effort: 0"), testing::HasSubstr("'max_effort' must be >= 1e-09, got 0"));
  for (const std::string key : {"max_effort", "max_velocity", "max_acceleration"})
    EXPECT_THAT(error_of(", " + key + ": 1e-300"), testing::HasSubstr("'" + key + "' must be >= 1e-09, got 1e-300"));
  EXPECT_THAT(error_of(", efficiency: 1.5"), testing::HasSubstr("'efficiency' must be > 0 and <= 1, got 1.5"));
}

}  // namespace
