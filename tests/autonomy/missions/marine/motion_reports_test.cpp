// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/motion_reports.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/autonomy/missions/marine/voyage.hpp"

namespace {

using autonomy::AttitudeReports;
using voyage_test::compass_at;
using voyage_test::not_a_number;
using voyage_test::second;

shoal::ins_t attitude_with(double yaw_rad) {
  shoal::ins_t attitude{};
  attitude.quat[0] = std::cos(0.5 * yaw_rad);
  attitude.quat[3] = std::sin(0.5 * yaw_rad);
  return attitude;
}

TEST(VelocityOf, ADvlIsOverGroundIfItCanBeAndElseThroughTheWater) {
  shoal::dvl_t dvl{};
  dvl.velocity_mps[0] = 2;
  dvl.water_velocity_mps[0] = 1;
  EXPECT_FALSE(autonomy::velocity_of(dvl));
  dvl.water_lock = 1;
  ASSERT_TRUE(autonomy::velocity_of(dvl));
  EXPECT_EQ(autonomy::velocity_of(dvl)->v_S.x(), 1);
  EXPECT_FALSE(autonomy::velocity_of(dvl)->over_ground);
  EXPECT_EQ(autonomy::velocity_of(dvl)->noise_mpsprtHz(), 0.3);
  dvl.bottom_lock = 1;
  EXPECT_EQ(autonomy::velocity_of(dvl)->v_S.x(), 2);
  EXPECT_TRUE(autonomy::velocity_of(dvl)->over_ground);
  EXPECT_EQ(autonomy::velocity_of(dvl)->noise_mpsprtHz(), 0);
  dvl.velocity_mps[1] = not_a_number;
  EXPECT_EQ(autonomy::velocity_of(dvl)->v_S.x(), 1);
}

TEST(AttitudeReports, OfACompassCountWhileTheAhrsIsSilent) {
  AttitudeReports attitude;
  EXPECT_FALSE(attitude.is_known());
  attitude.receive(0, compass_at(0, 0.1));
  EXPECT_NEAR(attitude.yaw_rad(), 0.1, 1e-12);
  attitude.receive(second, attitude_with(0.2));
  attitude.receive(2 * second, compass_at(0, 0.1));
  EXPECT_NEAR(attitude.yaw_rad(), 0.2, 1e-12);
  attitude.receive(3 * second, compass_at(0, 0.3));
  EXPECT_NEAR(attitude.yaw_rad(), 0.3, 1e-12);
}

TEST(AttitudeReports, AreThoseOfTheVehicleHoweverTheAhrsIsMounted) {
  AttitudeReports attitude;
  attitude.receive(0, attitude_with(0.5), Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ())));
  EXPECT_NEAR(attitude.yaw_rad(), 0.3, 1e-12);
}

TEST(AttitudeReports, AreLostWhenBothDevicesAreSilent) {
  AttitudeReports attitude;
  EXPECT_FALSE(attitude.is_lost(100 * second));  // there was none
  attitude.receive(0, attitude_with(0));
  attitude.receive(second, compass_at(0, not_a_number));
  attitude.receive(second, shoal::ins_t{});  // a quaternion of zeros
  EXPECT_FALSE(attitude.is_lost(2 * second));
  EXPECT_TRUE(attitude.is_lost(2 * second + 1));
  attitude.shift(second);
  EXPECT_FALSE(attitude.is_lost(3 * second));
}

}  // namespace
