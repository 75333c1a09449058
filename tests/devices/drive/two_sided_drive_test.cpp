// SPDX-License-Identifier: BSD-3-Clause
#include "shoal/thrust_rudder_command_t.hpp"
#include "shoal/wheel_speeds_command_t.hpp"
#include "tests/devices/drive/drive_support.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

constexpr const char* drive =
    "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, wheel_radius_m: 0.1,\n"
    "           track_m: 0.5, max_speed_mps: 2, max_turn_radps: 3, max_acceleration_mps2: 1000, max_torque_Nm: 100}\n";

using test::twist;

TEST(DifferentialDrive, SlowsBothWheelsAlikeWhereOneCannotTurnFastEnough) {
  test::TestWorld test(test::rover_world(drive));
  test.send("r1.drive.cmd", twist(2.0, 2.0));  // right wheel would need 2.5 m/s of at most 2
  test.run_for(0.5);
  const sim::Vehicle& rover = *test.world.find_vehicle("r1");
  // Scaled by 2 / 2.5: 16 rad/s and 1.6/0.1 - ... left = (2 - 0.5) * 0.8 / 0.1 = 12, right = 20.
  EXPECT_NEAR(rover.joint("left").velocity(), 12, 0.05);
  EXPECT_NEAR(rover.joint("right").velocity(), 20, 0.05);
}

TEST(DifferentialDrive, TakesThrustAndRudderAsAVessel) {
  test::TestWorld test(test::rover_world(drive));
  shoal::thrust_rudder_command_t command{};
  command.thrust = 0.5;
  command.rudder = 0.2;
  test.send("r1.drive.cmd", command);
  test.run_for(0.5);
  const sim::Vehicle& rover = *test.world.find_vehicle("r1");
  // Forward 0.5 * 2 = 1 m/s, turn 0.5 * 0.2 * 3 = 0.3 rad/s: wheels (1 -+ 0.25 * 0.3) / 0.1 rad/s.
  EXPECT_NEAR(rover.joint("left").velocity(), 9.25, 0.05);
  EXPECT_NEAR(rover.joint("right").velocity(), 10.75, 0.05);
}

TEST(DifferentialDrive, AChangeSlowsACommandThatIsTooFastNowAndKeepsItsCurvature) {
  test::TestWorld test(test::rover_world(drive));
  shoal::wheel_speeds_command_t command{};
  command.left_radps = 8;
  command.right_radps = -16;
  test.send("r1.drive.cmd", command);
  test.run_for(0.5);
  ASSERT_EQ(test.change("r1/drive", "{max_speed_mps: 0.4}"), "");
  test.run_for(0.1);
  const sim::Vehicle& rover = *test.world.find_vehicle("r1");
  EXPECT_NEAR(rover.joint("left").motor_velocity(), 2, 1e-12);  // 0.4 / 0.1 is the faster one's
  EXPECT_NEAR(rover.joint("right").motor_velocity(), -4, 1e-12);
}

TEST(DifferentialDrive, AChangeDoesNotEndCoasting) {
  std::string device(drive);
  device.insert(device.find("track_m"), "watchdog_s: 0.1, safe: coast, ");
  test::TestWorld test(test::rover_world(device));
  test.send("r1.drive.cmd", twist(0.5, 0));
  test.run_for(0.5);
  ASSERT_EQ(test.change("r1/drive", "{max_speed_mps: 0.1}"), "");
  test.run_for(0.1);
  EXPECT_EQ(test.world.find_vehicle("r1")->joint("left").motor_max_force(), 0);
}

}  // namespace
