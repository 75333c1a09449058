// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "shoal/wind_t.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using shoal::wind_t;
using test::marine_world;

constexpr double degree = std::numbers::pi / 180;

/// Air that moves to the north at 5 m/s, over the sensor at 5 m.
const char* const southerly = "{water: {surface_m: -5}, wind: {velocity_mps: [0, 5, 0]}}";

std::string sensor(const std::string& keys = "", const std::string& rpy_deg = "[0, 0, 0]",
                   const std::string& medium = southerly) {
  return marine_world("type: wind_sensor" + keys, "[0, 0, 0]", "[]", "", medium, rpy_deg);
}

wind_t truth(const std::string& world, const sim::Vector3d& v_W = sim::Vector3d::Zero()) {
  test::TestWorld test(world);
  test::set_velocity(test, v_W);
  test::Listener<wind_t> truths(test, "r1.s.truth");
  test.run_for(0.01);
  return truths.last();
}

TEST(WindSensor, AtRestTheApparentWindIsTheTrueOne) {
  // The sensor looks east: the south is 90 degrees to the right of it.
  const wind_t wind = truth(sensor());
  EXPECT_EQ(wind.valid, 1);
  EXPECT_NEAR(wind.apparent_speed_mps, 5, 1e-9);
  EXPECT_NEAR(wind.apparent_angle_rad, 90 * degree, 1e-9);
  EXPECT_NEAR(wind.true_speed_mps, 5, 1e-9);
  EXPECT_NEAR(wind.true_angle_rad, 90 * degree, 1e-9);
  EXPECT_NEAR(wind.true_direction_rad, 180 * degree, 1e-9);
}

TEST(WindSensor, AMovingSensorFeelsItsOwnWind) {
  // 5 m/s ahead make 5 m/s from ahead: with 5 m/s from the right, 5 sqrt(2) m/s from 45 degrees.
  const wind_t wind = truth(sensor(), {5, 0, 0});
  EXPECT_NEAR(wind.apparent_speed_mps, 5 * std::sqrt(2), 1e-9);
  EXPECT_NEAR(wind.apparent_angle_rad, 45 * degree, 1e-9);
  EXPECT_NEAR(wind.true_speed_mps, 5, 1e-9);
  EXPECT_NEAR(wind.true_direction_rad, 180 * degree, 1e-9);
}

TEST(WindSensor, DirectionsAreFromNorthWhateverItsHeading) {
  const wind_t wind = truth(sensor("", "[0, 0, 150]"), {1, -2, 0});
  EXPECT_NEAR(wind.true_speed_mps, 5, 1e-9);
  EXPECT_NEAR(wind.true_direction_rad, 180 * degree, 1e-9);
  EXPECT_NEAR(wind.true_angle_rad, -120 * degree, 1e-9);  // the heading is -60: south is 120 to the left
}

TEST(WindSensor, AHeeledSensorFeelsTheWindInItsPlane) {
  // Heeled by 60 degrees about x, the wind across it has half of its speed in the plane.
  EXPECT_NEAR(truth(sensor("", "[60, 0, 0]")).apparent_speed_mps, 2.5, 1e-9);
}

TEST(WindSensor, HasALeastAndALargestSpeed) {
  test::TestWorld slow(sensor(", threshold_mps: 6"));
  test::Listener<wind_t> slow_reports(slow, "r1.s");
  slow.run_for(0.01);
  EXPECT_EQ(slow_reports.last().apparent_speed_mps, 0);
  test::TestWorld fast(sensor(", speed_max_mps: 4"));
  test::Listener<wind_t> fast_reports(fast, "r1.s");
  fast.run_for(0.01);
  EXPECT_EQ(fast_reports.last().apparent_speed_mps, 4);
}

TEST(WindSensor, UnderWaterItIsInvalid) {
  const wind_t wind = truth(sensor("", "[0, 0, 0]", "{water: {surface_m: 1}, wind: {velocity_mps: [0, 5, 0]}}"));
  EXPECT_EQ(wind.valid, 0);
  EXPECT_TRUE(std::isnan(wind.apparent_speed_mps));
  EXPECT_TRUE(std::isnan(wind.true_direction_rad));
}

TEST(WindSensor, NoiseHasTheSpreadAskedFor) {
  test::TestWorld test(sensor(", speed_noise: {gaussian_std: 0.3}, angle_noise: {gaussian_std: 0.05}"));
  test::Listener<wind_t> reports(test, "r1.s");
  test.run_for(20);
  std::vector<double> speeds, angles;
  for (const wind_t& report : reports.take_all()) {
    speeds.push_back(report.apparent_speed_mps);
    angles.push_back(report.apparent_angle_rad);
  }
  const auto [speed, speed_std, count] = test::statistics(speeds);
  EXPECT_NEAR(speed, 5, 4 * 0.3 / std::sqrt(count));
  EXPECT_NEAR(speed_std, 0.3, 4 * 0.3 / std::sqrt(2 * count));
  const auto [angle, angle_std, again] = test::statistics(angles);
  EXPECT_NEAR(angle, 90 * degree, 4 * 0.05 / std::sqrt(again));
  EXPECT_NEAR(angle_std, 0.05, 4 * 0.05 / std::sqrt(2 * again));
}

TEST(WindSensor, AnErrorOfTheVelocityIsOneOfTheTrueWindOnly) {
  test::TestWorld test(sensor(", velocity_noise: {bias: 1}"));
  test::Listener<wind_t> reports(test, "r1.s");
  test.run_for(0.01);
  const wind_t wind = reports.last();
  EXPECT_NEAR(wind.apparent_speed_mps, 5, 1e-9);
  // It believes to go 1 m/s to the east and 1 m/s to the north: the air goes (1, 6).
  EXPECT_NEAR(wind.true_speed_mps, std::sqrt(37), 1e-9);
}

TEST(WindSensor, RefusesANegativeThreshold) {
  EXPECT_THAT(test::error_of_world(sensor(", threshold_mps: -1")),
              testing::HasSubstr("device 's': 'threshold_mps' must be >= 0, got -1"));
}

}  // namespace
