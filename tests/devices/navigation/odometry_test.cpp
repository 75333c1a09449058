// SPDX-License-Identifier: BSD-3-Clause
#include "shoal/odometry_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

std::string devices(const std::string& more) {
  return "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, track_m: 0.5}\n"
         "        - {name: odometry, type: odometry, left_joint: left, right_joint: right, track_m: 0.5, rate_hz: 50, "
         "truth: true" +
         more + "}\n";
}

void drive(test::TestWorld& test, double forward_mps, double turn_radps, double time_s) {
  shoal::twist_command_t command{};
  command.forward_mps = forward_mps;
  command.turn_radps = turn_radps;
  test.send("r1.drive.cmd", command);
  test.run_for(time_s);
}

TEST(Odometry, CountsTheTicksOfTheWheels) {
  test::TestWorld test(test::rover_world(devices(", ticks_per_revolution: 100")));
  test::Listener<shoal::odometry_t> reports(test, "r1.odometry");
  drive(test, 0.5, 0, 4);
  const auto last = reports.last();
  const double turned_rad = test.world.find_vehicle("r1")->joint("left").position();
  // The last report is up to one period (20 ms at 5 rad/s: 1.6 ticks) old, and a tick is cut off.
  EXPECT_NEAR(static_cast<double>(last.left_ticks), turned_rad / (2 * std::numbers::pi) * 100, 2.6);
  EXPECT_EQ(last.left_ticks, last.right_ticks);
  // Distance is ticks times the ground covered by a tick.
  EXPECT_NEAR(last.x_m, static_cast<double>(last.left_ticks) * 2 * std::numbers::pi * 0.1 / 100, 1e-9);
}

TEST(Odometry, AgreesWithTheTruthOnAnArcWithoutSlip) {
  test::TestWorld test(test::rover_world(devices(", ticks_per_revolution: 100000")));
  test::Listener<shoal::odometry_t> reports(test, "r1.odometry");
  test::Listener<shoal::odometry_t> truths(test, "r1.odometry.truth");
  drive(test, 0.4, 0.5, 10);
  const auto report = reports.last();
  const auto truth = truths.last();
  EXPECT_EQ(report.utime, truth.utime);
  EXPECT_NEAR(truth.theta_rad, 5.0, 0.15);  // not wrapped; 2 s^-1 ramp at the start
  // 4 m driven; a wheel slips by about 0.1 % as it starts and turns.
  EXPECT_NEAR(report.x_m, truth.x_m, 0.01);
  EXPECT_NEAR(report.y_m, truth.y_m, 0.01);
  EXPECT_NEAR(report.theta_rad, truth.theta_rad, 0.02);
}

TEST(Odometry, AWrongWheelRadiusScalesTheDistance) {
  test::TestWorld test(test::rover_world(devices(", wheel_radius_m: 0.101, ticks_per_revolution: 100000")));
  test::Listener<shoal::odometry_t> reports(test, "r1.odometry");
  test::Listener<shoal::odometry_t> truths(test, "r1.odometry.truth");
  drive(test, 0.5, 0, 8);
  EXPECT_NEAR(reports.last().x_m / truths.last().x_m, 1.01, 0.002);  // slip at the start
}

TEST(Odometry, NoiseOfTheWheelAnglesGrowsAsARandomWalk) {
  test::TestWorld test(test::rover_world(devices(", ticks_per_revolution: 1000000, noise: {gaussian_std: 0.01}")));
  test::Listener<shoal::odometry_t> reports(test, "r1.odometry");
  test.run_for(20);  // standing: 1000 samples
  double sum = 0;
  std::int64_t before = 0;
  const auto all = reports.take_all();
  for (const auto& report : all) {
    const double turned_rad = static_cast<double>(report.left_ticks - before) * 2 * std::numbers::pi / 1e6;
    before = report.left_ticks;
    sum += turned_rad * turned_rad;
  }
  ASSERT_EQ(all.size(), 1000u);
  EXPECT_NEAR(std::sqrt(sum / 1000), 0.01, 0.001);  // 4 sigma of a standard deviation from 1000 samples is 9 %
}

}  // namespace
