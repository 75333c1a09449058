// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/ackermann_drive.hpp"

#include <gmock/gmock.h>

#include "shoal/ackermann_command_t.hpp"
#include "shoal/thrust_rudder_command_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// A car with wheelbase 0.4 m and track 0.3 m; its frame is under the middle of the rear axle.
std::string car_world(const std::string& drive) {
  std::string bodies, joints;
  for (const auto& [name, x, y] : std::vector<std::tuple<std::string, std::string, std::string>>{
           {"rl", "0", "0.15"}, {"rr", "0", "-0.15"}, {"fl", "0.4", "0.15"}, {"fr", "0.4", "-0.15"}}) {
    bodies += "        - {name: " + name + "_wheel, position_m: [" + x + ", " + y +
              ", 0.06], parts: [{shape: sphere, radius_m: 0.06, mass_kg: 0.3}]}\n";
    const std::string axes =
        name[0] == 'f' ? "hinge2, axis: [0, 0, 1], axis2: {axis: [0, 1, 0]}" : std::string("hinge, axis: [0, 1, 0]");
    joints += "        - {name: " + name + ", type: " + axes + ", bodies: [base, " + name + "_wheel], anchor_m: [" + x +
              ", " + y + ", 0.06]}\n";
  }
  return R"(
shoal: 1
physics: {step_s: 0.001}
contacts: [{between: [any, any], friction: 1}]
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
vehicles:
  - name: c1
    model:
      shoal: 1
      vehicle: car
      bodies:
        - {name: base, parts: [{shape: box, size_m: [0.5, 0.2, 0.05], position_m: [0.2, 0, 0.08], mass_kg: 4}]}
)" + bodies +
         "      joints:\n" + joints +
         "      devices:\n        - {name: drive, type: ackermann_drive, left_steer_joint: fl, right_steer_joint: fr,\n"
         "           wheelbase_m: 0.4, track_m: 0.3, wheel_radius_m: 0.06" +
         drive + "}\n";
}

const std::string rear = ", drive_joints: [rl, rr]";

void steer(test::TestWorld& test, double speed_mps, double steering_rad) {
  shoal::ackermann_command_t command{};
  command.speed_mps = speed_mps;
  command.steering_rad = steering_rad;
  test.send("c1.drive.cmd", command);
}

const sim::Vehicle& car(const test::TestWorld& test) {
  return *test.world.find_vehicle("c1");
}

/// Radius of the circle of the rear axle's middle, by its way and turn in 3 s.
double radius_m(test::TestWorld& test) {
  double distance_m = 0, turned_rad = 0;
  for (int i = 0; i < 300; ++i) {
    const sim::Pose before = car(test).X_WV();
    test.run_for(0.01);
    const sim::Pose moved = before.inverse() * car(test).X_WV();
    distance_m += moved.translation().head<2>().norm();
    turned_rad += sim::yaw_of(moved.linear());
  }
  return distance_m / turned_rad;
}

TEST(AckermannDrive, DrivesTheCircleOfItsWheelbaseAndSteering) {
  for (const std::string drive : {", drive_joints: [rl, rr]", ", drive_joints: [rl, rr, fl, fr]"})
    for (const double steering_rad : {0.3, -0.4}) {
      test::TestWorld test(car_world(drive));
      steer(test, 0.6, steering_rad);
      test.run_for(1);
      const double expected = 0.4 / std::tan(steering_rad);
      // 0.2 %: wheels that hold the car on its circle creep sideways by the contacts' softness.
      EXPECT_NEAR(radius_m(test), expected, 0.002 * std::abs(expected)) << drive << steering_rad;
      EXPECT_NEAR((car(test).X_WV().linear().transpose() * car(test).base().v_WB_W()).x(), 0.6, 0.01);
    }
}

TEST(AckermannDrive, WheelsPointToOneCenterOfTurn) {
  test::TestWorld test(car_world(rear));
  steer(test, 0, 0.4);
  test.run_for(1);
  // Cotangents differ by track / wheelbase about that of the middle.
  const double cot = 1 / std::tan(0.4);
  EXPECT_NEAR(1 / std::tan(car(test).joint("fl").position(0)), cot - 0.15 / 0.4, 1e-3);
  EXPECT_NEAR(1 / std::tan(car(test).joint("fr").position(0)), cot + 0.15 / 0.4, 1e-3);
}

TEST(AckermannDrive, SteersNoFasterAndNoFartherThanItsLimits) {
  test::TestWorld test(car_world(rear + ", max_steering_deg: 20, max_steering_rate_radps: 0.5"));
  const auto& drive = dynamic_cast<const devices::AckermannDrive&>(*car(test).find_device("drive")->actuator());
  steer(test, 0, 1);
  test.run_for(0.4);
  EXPECT_NEAR(drive.steering_rad(), 0.2, 1e-12);
  test.run_for(2);
  EXPECT_NEAR(drive.steering_rad(), sim::degrees_to_radians(20), 1e-12);
}

TEST(AckermannDrive, WithADifferentialTheOuterWheelTurnsFaster) {
  for (const bool differential : {true, false}) {
    test::TestWorld test(car_world(rear + (differential ? "" : ", differential: false")));
    steer(test, 0.6, 0.3);
    test.run_for(1);
    const double half = differential ? 0.15 * std::tan(0.3) / 0.4 : 0;
    EXPECT_NEAR(car(test).joint("rl").motor_velocity(), 10 * (1 - half), 1e-9);
    EXPECT_NEAR(car(test).joint("rr").motor_velocity(), 10 * (1 + half), 1e-9);
  }
}

TEST(AckermannDrive, DrivesStraight) {
  test::TestWorld test(car_world(rear));
  steer(test, 0.5, 0);
  test.run_for(1);
  const double x0 = car(test).X_WV().translation().x();
  test.run_for(4);
  EXPECT_NEAR(car(test).X_WV().translation().x() - x0, 2.0, 0.002);  // 0.1 %: contact softness (cfm)
  EXPECT_NEAR(car(test).X_WV().translation().y(), 0.0, 1e-3);
}

TEST(AckermannDrive, ATwistTurnsAtItsRateForwardsAndBackwards) {
  for (const double forward_mps : {0.5, -0.5}) {
    test::TestWorld test(car_world(rear));
    shoal::twist_command_t command{};
    command.forward_mps = forward_mps;
    command.turn_radps = 0.4;
    test.send("c1.drive.cmd", command);
    test.run_for(2);
    EXPECT_NEAR(car(test).base().w_WB_W().z(), 0.4, 0.0008) << forward_mps;  // 0.2 % as of the circle
  }
}

TEST(AckermannDrive, TakesThrustAndRudderAsAVessel) {
  test::TestWorld test(car_world(rear + ", max_speed_mps: 1.2, max_steering_deg: 20, differential: false"));
  shoal::thrust_rudder_command_t command{};
  command.thrust = 0.5;
  command.rudder = -1;
  test.send("c1.drive.cmd", command);
  test.run_for(1);
  EXPECT_NEAR(car(test).joint("rl").motor_velocity(), 10, 1e-9);
  const double tangent = std::tan(sim::degrees_to_radians(20));
  EXPECT_NEAR(car(test).joint("fl").position(0), -std::atan(0.4 * tangent / (0.4 + 0.15 * tangent)), 0.01);
}

TEST(AckermannDrive, SafeItBrakesOrRollsOn) {
  for (const std::string safe : {"stop", "coast"}) {
    test::TestWorld test(car_world(rear + ", watchdog_s: 1, safe: " + safe));
    steer(test, 0.6, 0);
    test.run_for(3);
    EXPECT_NEAR(car(test).base().v_WB_W().x(), safe == "stop" ? 0 : 0.6, 0.01) << safe;
  }
}

TEST(AckermannDrive, AChangeCutsTheStandingCommandAndLetsItCoast) {
  test::TestWorld test(car_world(rear + ", max_acceleration_mps2: 1000, watchdog_s: 1, safe: coast"));
  steer(test, 0.6, 0.4);
  test.run_for(0.5);
  ASSERT_EQ(test.change("c1/drive", "{max_speed_mps: 0.3, max_steering_deg: 10, differential: false}"), "");
  test.run_for(0.4);
  EXPECT_NEAR(car(test).joint("rl").motor_velocity(), 0.3 / 0.06, 1e-9);
  const auto& drive = dynamic_cast<const devices::AckermannDrive&>(*car(test).find_device("drive")->actuator());
  EXPECT_NEAR(drive.steering_rad(), sim::degrees_to_radians(10), 1e-12);
  test.run_for(0.5);
  ASSERT_EQ(car(test).joint("rl").motor_max_force(), 0);
  ASSERT_EQ(test.change("c1/drive", "{max_torque_Nm: 2}"), "");
  test.run_for(0.1);
  EXPECT_EQ(car(test).joint("rl").motor_max_force(), 0);
}

TEST(AckermannDrive, AWheelbaseThatChangesReachesTheWheelsToo) {
  test::TestWorld test(car_world(", drive_joints: [fl]"));
  ASSERT_EQ(test.change("c1/drive", "{wheelbase_m: 0.5}"), "");
  steer(test, 0.6, 0.3);
  test.run_for(1);
  // The wheel is 0.5 m before the center of turn and (0.5 / tan 0.3 - 0.15) m beside it; 10 rad/s in the middle.
  const double ratio = std::hypot(1 - 0.15 * std::tan(0.3) / 0.5, std::tan(0.3));
  EXPECT_NEAR(car(test).joint("fl").motor_velocity(1), 10 * ratio, 1e-9);
}

TEST(AckermannDrive, SaysWhatIsWrongWithItsParameters) {
  const auto error_of = [](const std::string& drive) -> std::string {
    try {
      test::TestWorld test(car_world(drive));
      return "";
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(error_of(""), testing::HasSubstr("device 'drive': missing key 'drive_joints'"));
  EXPECT_THAT(error_of(rear + ", max_steering_deg: 80"),
              testing::HasSubstr("at 'max_steering_deg' the center of turn must lie outside the track"));
  EXPECT_THAT(error_of(rear + ", max_speed_mps: -1"), testing::HasSubstr("'max_speed_mps' must be > 0, got -1"));
}

}  // namespace
