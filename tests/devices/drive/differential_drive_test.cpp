// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/differential_drive.hpp"

#include "shoal/wheel_speeds_command_t.hpp"
#include "tests/devices/drive/drive_support.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

constexpr const char* drive =
    "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, wheel_radius_m: 0.1,\n"
    "           track_m: 0.5, max_speed_mps: 2, max_turn_radps: 3, max_acceleration_mps2: 1000, max_torque_Nm: 100}\n";

using test::twist;

sim::Pose pose_of(const test::TestWorld& test) {
  return test.world.find_vehicle("r1")->X_WV();
}

TEST(DifferentialDrive, WheelSpeedsGiveTheArcOfTheTextbook) {
  test::TestWorld test(test::rover_world(drive));
  shoal::wheel_speeds_command_t command{};
  command.left_radps = 6;   // 0.6 m/s
  command.right_radps = 9;  // 0.9 m/s
  test.send("r1.drive.cmd", command);
  test.run_for(1);  // the wheels spin until the rover has come up to speed
  const sim::Pose X_W0 = pose_of(test);
  test.run_for(8);
  const sim::Pose X_0V = X_W0.inverse() * pose_of(test);
  // v = 0.75 m/s, w = 0.6 rad/s: x = v/w sin(wt), y = v/w (1 - cos(wt)), wt = 4.8 rad (reference closed_forms.csv,
  // diff_drive_arc).  1 % of the path's radius for wheel slip.
  EXPECT_NEAR(X_0V.translation().x(), -1.245205761, 0.0125);
  EXPECT_NEAR(X_0V.translation().y(), 1.140626271, 0.0125);
  EXPECT_NEAR(sim::yaw_of(X_0V.linear()), 4.8 - 2 * std::numbers::pi, 0.048);
}

TEST(DifferentialDrive, DrivesStraightAtTheCommandedSpeed) {
  test::TestWorld test(test::rover_world(drive));
  test.send("r1.drive.cmd", twist(0.5, 0));
  test.run_for(1);
  const double x0 = pose_of(test).translation().x();
  test.run_for(4);
  EXPECT_NEAR(pose_of(test).translation().x() - x0, 2.0, 0.002);  // 0.1 %: contact softness (cfm)
  EXPECT_NEAR(pose_of(test).translation().y(), 0.0, 1e-6);        // symmetric to rounding
}

TEST(DifferentialDrive, StandsStillUntilTheFirstCommand) {
  test::TestWorld test(test::rover_world(drive));
  test.run_for(2);
  EXPECT_LT(pose_of(test).translation().head<2>().norm(), 1e-6);
}

TEST(DifferentialDrive, IgnoresBadCommandsAndContinues) {
  test::TestWorld test(test::rover_world(drive));
  test.send("r1.drive.cmd", twist(0.5, 0));
  test.run_for(0.5);
  const auto publish = [&](const sim::Bytes& payload) { test.bus.publish("r1.drive.cmd", payload, test.world.now()); };
  publish({});
  publish(sim::Bytes(8));  // an unknown fingerprint
  sim::Bytes cut = shoal::encode(twist(-1, 0));
  cut.pop_back();
  publish(cut);
  publish(shoal::encode(twist(std::nan(""), 0)));
  test.run_for(0.5);
  EXPECT_EQ(test.world.counts().bad_messages, 4);
  EXPECT_NEAR(test.world.find_vehicle("r1")->joint("left").velocity(), 5, 0.05);
}

TEST(DifferentialDrive, ActuatorLatencyShiftsTheResponseByExactlyThatTime) {
  const auto speeds = [](const char* latency) {
    std::string device(drive);
    device.insert(device.find("track_m"), latency);
    test::TestWorld test(test::rover_world(device));
    test.run_for(0.1);
    test.send("r1.drive.cmd", twist(0.5, 0));
    std::vector<double> left;
    for (int i = 0; i < 100; ++i) {
      test.world.step();
      left.push_back(test.world.find_vehicle("r1")->joint("left").motor_velocity());
    }
    return left;
  };
  const std::vector<double> prompt = speeds("");
  const std::vector<double> late = speeds("latency_s: 0.02, ");
  ASSERT_GT(prompt[0], 0);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(late[i], 0) << i;  // 20 steps of 1 ms
  for (std::size_t i = 20; i < 100; ++i) EXPECT_EQ(late[i], prompt[i - 20]) << i;
}

}  // namespace
