// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/vehicle_navigation.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace {

using bridges::VehicleNavigation;
using enum bridges::NavField;
using Position = VehicleNavigation::Position;

shoal::gps_data_t fix_at(double east_m, double north_m) {
  shoal::gps_data_t gps{};
  gps.gps_lock = 1;
  gps.latitude = 43;
  gps.longitude = -70;
  gps.speed = 1.5;
  gps.xyz_pos[0] = east_m;
  gps.xyz_pos[1] = north_m;
  return gps;
}

TEST(VehicleNavigation, HeadingsAreClockwiseFromNorth) {
  EXPECT_NEAR(bridges::heading_deg_of(0), 90, 1e-12);  // east
  EXPECT_NEAR(bridges::heading_deg_of(std::numbers::pi / 2), 0, 1e-12);
  EXPECT_NEAR(bridges::heading_deg_of(std::numbers::pi), 270, 1e-12);
  EXPECT_NEAR(bridges::heading_deg_of(-std::numbers::pi / 4), 135, 1e-12);
  for (double heading_deg = 0; heading_deg < 360; heading_deg += 7)
    EXPECT_NEAR(bridges::heading_deg_of(bridges::yaw_rad_of(heading_deg)), heading_deg, 1e-9);
  EXPECT_TRUE(std::isnan(bridges::yaw_rad_of(std::nan(""))));
}

TEST(VehicleNavigation, PositionAndSpeedAreThoseOfTheGps) {
  VehicleNavigation navigation("a");
  EXPECT_FALSE(navigation.has(x));
  EXPECT_EQ(navigation.take(fix_at(10, 20)).size(), 5U);
  EXPECT_EQ(navigation[x], 10);
  EXPECT_EQ(navigation[y], 20);
  EXPECT_EQ(navigation[latitude], 43);
  EXPECT_EQ(navigation[speed], 1.5);
  shoal::gps_data_t lost = fix_at(99, 99);
  lost.gps_lock = 0;
  EXPECT_TRUE(navigation.take(lost).empty());
  EXPECT_EQ(navigation[x], 10);
}

TEST(VehicleNavigation, AnAttitudeHasTheNoseUpAndStarboardDownPositive) {
  VehicleNavigation navigation("a");
  shoal::ins_t ahrs{};
  // Yaw 90 deg (north), then pitch -10 deg about y, to the left: the nose rises.
  const double yaw_rad = std::numbers::pi / 2, pitch_rad = -10 * std::numbers::pi / 180;
  const double cy = std::cos(yaw_rad / 2), sy = std::sin(yaw_rad / 2);
  const double cp = std::cos(pitch_rad / 2), sp = std::sin(pitch_rad / 2);
  const double q[4] = {cy * cp, -sy * sp, cy * sp, sy * cp};
  std::copy(q, q + 4, ahrs.quat);
  EXPECT_EQ(navigation.take(ahrs).size(), 3U);
  EXPECT_NEAR(navigation[heading], 0, 1e-9);
  EXPECT_NEAR(navigation[pitch], 10, 1e-9);
  EXPECT_NEAR(navigation[roll], 0, 1e-9);
  // Roll of 20 deg about x, forward: port rises.
  const double half = 10 * std::numbers::pi / 180, rolled[4] = {std::cos(half), std::sin(half), 0, 0};
  std::copy(rolled, rolled + 4, ahrs.quat);
  navigation.take(ahrs);
  EXPECT_NEAR(navigation[roll], 20, 1e-9);
  EXPECT_NEAR(navigation[heading], 90, 1e-9);
}

TEST(VehicleNavigation, TheTruthIsTakenOnlyOnRequest) {
  shoal::sim_state_t state{};
  state.count = 2;
  state.vehicle = {"b", "a"};
  state.position_m = {{1, 2, 3}, {100, 200, -5}};
  state.orientation = {{1, 0, 0, 0}, {1, 0, 0, 0}};
  state.velocity_mps = {{0, 0, 0}, {3, 4, 0}};
  VehicleNavigation by_devices("a"), by_truth("a", Position::truth);
  EXPECT_TRUE(by_devices.take(state).empty());
  EXPECT_FALSE(by_devices.has(x));
  by_truth.set_origin(43, -70);
  EXPECT_EQ(by_truth.take(state).size(), 9U);
  EXPECT_EQ(by_truth[x], 100);
  EXPECT_EQ(by_truth[depth], 5);
  EXPECT_EQ(by_truth[speed], 5);
  EXPECT_EQ(by_truth[heading], 90);
  EXPECT_NEAR(by_truth[latitude], 43 + 200 / 111'100.0, 1e-5);  // a degree of latitude has 111.1 km here
  EXPECT_TRUE(by_truth.take(fix_at(1, 1)).empty());
}

TEST(VehicleNavigation, UnderWaterSpeedIsThatOfTheDvlAndPositionAnEstimate) {
  VehicleNavigation navigation("a", Position::estimate);
  shoal::estimate_t estimate{};
  estimate.position_m[0] = 7;
  estimate.velocity_mps[1] = 2;
  EXPECT_EQ(navigation.take(estimate).size(), 5U);
  EXPECT_EQ(navigation[x], 7);
  EXPECT_EQ(navigation[speed], 2);
  EXPECT_FALSE(navigation.has(latitude));  // the origin is unknown
  VehicleNavigation dives("a");
  shoal::dvl_t dvl{};
  dvl.bottom_lock = 1;
  dvl.altitude_m = 12;
  dvl.velocity_mps[0] = 1.25;
  dives.take(dvl);
  EXPECT_EQ(dives[altitude], 12);
  EXPECT_EQ(dives[speed], 1.25);
  dives.take(fix_at(0, 0));
  dives.take(dvl);
  EXPECT_EQ(dives[speed], 1.5);
  shoal::pressure_t pressure{};
  pressure.depth_m = 3;
  dives.take(pressure);
  EXPECT_EQ(dives[depth], 3);
}

}  // namespace
