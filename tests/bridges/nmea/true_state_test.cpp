// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/nmea/true_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using bridges::nmea::TrueState;

constexpr double degree = std::numbers::pi / 180;

shoal::sim_info_t info(const std::string& world) {
  shoal::sim_info_t info{};
  info.resolved_config = world;
  return info;
}

/// One boat at the origin that goes north at 2 m/s and looks east, another one 1000 m north of it.
shoal::sim_state_t two_boats() {
  shoal::sim_state_t state{};
  state.utime = 5'000'000;
  state.count = 2;
  state.vehicle = {"one", "two"};
  state.position_m = {{0, 0, 0}, {0, 1000, 0}};
  state.orientation = {{1, 0, 0, 0}, {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}};  // yaw 0 and 90 degrees
  state.velocity_mps = {{0, 2, 0}, {-3, 0, 0}};
  state.angular_velocity_radps = {{0, 0, 0.1}, {0, 0, -0.02}};
  return state;
}

TEST(TrueState, TheOwnShipHasAPerfectFix) {
  TrueState truth("one");
  EXPECT_FALSE(truth.receive(two_boats()));  // the origin is not known
  truth.receive(info("origin: {latitude_deg: 60, longitude_deg: 20}"));
  ASSERT_TRUE(truth.receive(two_boats()));
  EXPECT_EQ(truth.gps().gps_lock, 1);
  EXPECT_NEAR(truth.gps().latitude, 60, 1e-9);
  EXPECT_NEAR(truth.gps().longitude, 20, 1e-9);
  EXPECT_NEAR(truth.gps().speed, 2, 1e-9);
  EXPECT_NEAR(truth.gps().heading, 0, 1e-9);
  EXPECT_EQ(truth.gps().gps_time, 5);
  EXPECT_EQ(truth.ins().quat[0], 1);
  EXPECT_NEAR(truth.ins().gyro[2], 0.1, 1e-12);
}

TEST(TrueState, TheOthersAreTargetsWithTheirNamesOnceAMinute) {
  TrueState truth("one");
  truth.receive(info("name: nowhere"));  // the default origin
  ASSERT_TRUE(truth.receive(two_boats()));
  const auto first = truth.ais(0);
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0].type, 1);
  EXPECT_EQ(first[0].mmsi, 200'000'001);
  // 1000 m are 1 / 111.08 degrees of latitude at 42 degrees.
  EXPECT_NEAR(first[0].latitude, 42.3584 + 1 / 111.08, 1e-5);
  EXPECT_NEAR(first[0].speed_mps, 3, 1e-9);
  EXPECT_NEAR(first[0].course_rad, -90 * degree, 1e-4);
  EXPECT_NEAR(first[0].heading_rad, 0, 1e-9);
  EXPECT_NEAR(first[0].turn_radps, 0.02, 1e-12);
  EXPECT_EQ(first[1].type, 5);
  EXPECT_EQ(first[1].name, "two");
  EXPECT_EQ(truth.ais(59'000'000).size(), 1u);
  EXPECT_EQ(truth.ais(60'000'000).size(), 2u);
}

TEST(TrueState, AShipThatIsNotThereHasNoState) {
  TrueState truth("three");
  truth.receive(info("{}"));
  EXPECT_FALSE(truth.receive(two_boats()));
}

}  // namespace
