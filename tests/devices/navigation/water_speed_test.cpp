// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/water_speed_t.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using shoal::water_speed_t;
using test::marine_world;

water_speed_t truth_in_water(const std::string& keys, const sim::Vector3d& v_W,
                             const std::string& medium = "{water: {surface_m: 0}}",
                             const std::string& position_m = "[0, 0, -10]") {
  test::TestWorld test(
      marine_world("type: water_speed" + keys, position_m, "[]", "", medium, "[0, 0, 90]"));  // looks north
  test::set_velocity(test, v_W);
  test::Listener<water_speed_t> truths(test, "r1.s.truth");
  test.run_for(0.01);
  return truths.last();
}

TEST(WaterSpeed, IsTheSpeedThroughTheWaterAlongItsAxis) {
  const char* current = "{water: {surface_m: 0}, current: {velocity_mps: [0.3, -0.5, 0]}}";
  EXPECT_NEAR(truth_in_water("", {0.2, 1, 0}, current).speed_mps, 1.5, 1e-9);
  EXPECT_NEAR(truth_in_water("", {0.2, -1, 0}, current).speed_mps, -0.5, 1e-9);
}

TEST(WaterSpeed, SensesTheSignOrNot) {
  EXPECT_NEAR(truth_in_water(", senses: both", {0, -1, 0}).speed_mps, -1, 1e-9);
  EXPECT_EQ(truth_in_water(", senses: forward", {0, -1, 0}).speed_mps, 0);
  EXPECT_NEAR(truth_in_water(", senses: magnitude", {0, -1, 0}).speed_mps, 1, 1e-9);
}

TEST(WaterSpeed, SticksBelowItsThresholdAndStopsAtItsMost) {
  EXPECT_EQ(truth_in_water(", threshold_mps: 0.3", {0, 0.29, 0}).speed_mps, 0);
  EXPECT_NEAR(truth_in_water(", threshold_mps: 0.3", {0, 0.31, 0}).speed_mps, 0.31, 1e-9);
  EXPECT_EQ(truth_in_water(", speed_max_mps: 2", {0, 3, 0}).speed_mps, 2);
}

TEST(WaterSpeed, IsInvalidInAirAndInADryWorld) {
  for (const char* medium : {"{water: {surface_m: -20}}", "{}"}) {
    const auto report = truth_in_water("", {0, 1, 0}, medium);
    EXPECT_EQ(report.valid, 0) << medium;
    EXPECT_EQ(report.speed_mps, 0) << medium;
  }
  EXPECT_EQ(truth_in_water("", {0, 1, 0}).valid, 1);
}

TEST(WaterSpeed, NoiseHasTheSpreadAskedFor) {
  test::TestWorld test(marine_world("type: water_speed, speed_noise: {gaussian_std: 0.1}"));
  test::Listener<water_speed_t> reports(test, "r1.s");
  test.run_for(20);
  std::vector<double> speeds;
  for (const auto& report : reports.take_all()) speeds.push_back(report.speed_mps);
  const auto [mean, std, count] = test::statistics(speeds);
  EXPECT_NEAR(mean, 0, 4 * 0.1 / std::sqrt(count));
  EXPECT_NEAR(std, 0.1, 4 * 0.1 / std::sqrt(2 * count));
}

TEST(WaterSpeed, RefusesANegativeThreshold) {
  EXPECT_THAT(test::error_of_world(marine_world("type: water_speed, threshold_mps: -1")),
              testing::HasSubstr("device 's': 'threshold_mps' must be >= 0, got -1"));
}

}  // namespace
