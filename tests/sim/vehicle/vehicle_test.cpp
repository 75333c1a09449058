// SPDX-License-Identifier: BSD-3-Clause
// The vehicles of vehicles/, driven in their worlds.

#include <gtest/gtest.h>

#include "shoal/ackermann_command_t.hpp"
#include "shoal/battery_t.hpp"
#include "shoal/bumper_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/joint_state_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/wheel_encoder_t.hpp"
#include "shoal/wrench_t.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

/// A world of worlds/ with its one vehicle.
struct Driven : test::LoadedTestWorld {
  explicit Driven(const std::string& name) : LoadedTestWorld(test_support::source_path("worlds/") + name + ".yaml") {}
  const sim::Vehicle& vehicle() const { return *world.vehicles().front(); }
  sim::Vector3d position() const { return vehicle().X_WV().translation(); }
};

shoal::twist_command_t twist(double forward_mps, double turn_radps) {
  shoal::twist_command_t command{};
  command.forward_mps = forward_mps;
  command.turn_radps = turn_radps;
  return command;
}

/// Commands for a while, again and again, so that no watchdog stops it.
template <typename Message>
void command_for(Driven& driven, const std::string& channel, const Message& message, double time_s) {
  for (double t = 0; t < time_s - 1e-9; t += 0.1) {
    driven.send(channel, message);
    driven.run_for(0.1);
  }
}

TEST(Pioneer, DrivesTwoMetersInFourSeconds) {
  Driven driven("pioneer_yard");
  test::Listener<shoal::wheel_encoder_t> encoder(driven, "pioneer1.encoder");
  test::Listener<shoal::battery_t> battery(driven, "pioneer1.battery");
  command_for(driven, "pioneer1.drive.cmd", twist(0.5, 0), 2);  // it comes up to speed
  const double x0 = driven.position().x();
  const auto ticks0 = encoder.last().ticks[0];
  command_for(driven, "pioneer1.drive.cmd", twist(0.5, 0), 4);
  EXPECT_NEAR(driven.position().x() - x0, 2, 0.1);
  EXPECT_NEAR(driven.position().y(), 0, 0.02);
  // 34000 ticks on 2 pi 0.111 m; a report may be 0.1 s old.
  EXPECT_NEAR(static_cast<double>(encoder.last().ticks[0] - ticks0) / 34000 * 2 * std::numbers::pi * 0.111, 2, 0.1);
  const auto charge = battery.last();
  EXPECT_LT(charge.charge, 1);
  EXPECT_GT(259 * 3600 - charge.energy_J, 5 * 60);  // 60 W at rest, 5 s at least at the last report
}

TEST(Pioneer, TurnsByTheTrackOfItsFile) {
  Driven driven("pioneer_yard");
  command_for(driven, "pioneer1.drive.cmd", twist(0, 1), 2);
  const double yaw_rad = sim::yaw_of(driven.vehicle().X_WV().linear());
  command_for(driven, "pioneer1.drive.cmd", twist(0, 1), 3);
  const double turned_rad = sim::wrap_angle(sim::yaw_of(driven.vehicle().X_WV().linear()) - yaw_rad);
  EXPECT_NEAR(turned_rad, 3, 0.015);  // 0.5 %: softness of the contacts
}

TEST(Pioneer, FeelsTheWall) {
  Driven driven("pioneer_yard");
  test::Listener<shoal::bumper_t> bumper(driven, "pioneer1.bumper");
  command_for(driven, "pioneer1.drive.cmd", twist(0.7, 0), 9);  // 4.6 m to go
  const auto report = bumper.last();
  EXPECT_EQ(report.touching, 1);
  EXPECT_EQ(report.part[0], "base/front_bumper");
  EXPECT_EQ(report.other[0], "wall");
}

TEST(AckermannCar, DrivesTheCircleOfItsSteering) {
  Driven driven("ackermann_track");
  shoal::ackermann_command_t command{};
  command.speed_mps = 0.8;
  command.steering_rad = 0.35;
  command_for(driven, "car1.drive.cmd", command, 1);
  double distance_m = 0, turned_rad = 0;
  for (int i = 0; i < 50; ++i) {
    driven.send("car1.drive.cmd", command);
    const sim::Pose before = driven.vehicle().X_WV();
    driven.run_for(0.05);
    const sim::Pose moved = before.inverse() * driven.vehicle().X_WV();
    distance_m += moved.translation().head<2>().norm();
    turned_rad += sim::yaw_of(moved.linear());
  }
  const double radius_m = 0.33 / std::tan(0.35);
  EXPECT_NEAR(distance_m / turned_rad, radius_m, 0.005 * radius_m);  // 0.5 %: creep of the tires
  EXPECT_NEAR(distance_m, 0.8 * 2.5, 0.005 * 2);
}

TEST(AckermannCar, StopsWithoutCommandsAndWhenItHitsAWall) {
  Driven driven("ackermann_track");
  shoal::ackermann_command_t command{};
  command.speed_mps = 2;
  driven.send("car1.drive.cmd", command);
  driven.run_for(2);
  EXPECT_NEAR(driven.vehicle().base().v_WB_W().norm(), 0, 0.01);
  EXPECT_FALSE(driven.vehicle().systems().estopped);
  command_for(driven, "car1.drive.cmd", command, 6);
  EXPECT_TRUE(driven.vehicle().systems().estopped);
  EXPECT_NEAR(driven.vehicle().base().v_WB_W().norm(), 0, 0.01);
}

TEST(RoverArm, ReachesAPoseAndWeighsItsHand) {
  Driven driven("arm_reach");
  test::Listener<shoal::joint_state_t> joints(driven, "rover1.joints");
  test::Listener<shoal::wrench_t> load(driven, "rover1.wrist_load");
  const std::vector<std::pair<std::string, double>> pose = {
      {"waist", 0.5}, {"shoulder", 0.7}, {"elbow", 0.9}, {"left_grip", 0.02}, {"right_grip", 0.02}};
  for (const auto& [name, position] : pose) {
    shoal::joint_servo_command_t command{};
    command.position = position;
    driven.send("rover1." + name + ".cmd", command);
  }
  driven.run_for(4);
  const auto report = joints.last();
  for (std::size_t i = 0; i < pose.size(); ++i) {
    EXPECT_EQ(report.joint_name[i], pose[i].first);
    EXPECT_NEAR(report.joint_position[i], pose[i].second, 0.002) << pose[i].first;  // steps of 0.0015 rad
  }
  EXPECT_LT(driven.position().head<2>().norm(), 0.01);  // the rover stands still
  // The arm tilts forward by 1.6 rad: palm and fingers, 0.16 kg, weigh on the wrist.
  const auto wrench = load.last();
  const sim::Vector3d force_N(wrench.force_N[0], wrench.force_N[1], wrench.force_N[2]);
  EXPECT_NEAR(force_N.norm(), 0.16 * 9.80665, 4 * 0.05);  // four standard deviations of its noise
}

}  // namespace
