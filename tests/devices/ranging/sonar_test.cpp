// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/sonar.hpp"

#include <gmock/gmock.h>

#include "shoal/sonar_range_t.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"

namespace {

using shoal::sonar_range_t;
using sim::degrees_to_radians;
using test::first_truth;
using test::ranging_world;
using test::wall_at;

TEST(Sonar, ReceivesTheNearestPointOfAWallOffItsAxis) {
  const auto range = [](double yaw_deg) {
    return first_truth<sonar_range_t>(
               ranging_world("type: sonar, beam_deg: 60, rays: 4000, rpy_deg: [0, 0, " + std::to_string(yaw_deg) + "]",
                             wall_at(5)))
        .range_m;
  };
  // Rays are 0.015 rad apart: the nearest is within that of the nearest point.
  EXPECT_NEAR(range(0), 5, 1e-3);
  EXPECT_NEAR(range(20), 5, 1e-3);                      // on its axis it is 5.32 m
  const double edge_rad = degrees_to_radians(50 - 30);  // the edge of the cone comes nearest
  EXPECT_NEAR(range(50), 5 / std::cos(edge_rad), 5 / std::cos(edge_rad) * std::tan(edge_rad) * 0.015);
}

TEST(Sonar, ReceivesNothingBelowItsThresholdAndOutOfRange) {
  const auto deaf = first_truth<sonar_range_t>(ranging_world("type: sonar, threshold_dB: 190", wall_at(5)));
  EXPECT_EQ(deaf.valid, 0);
  EXPECT_EQ(deaf.range_m, 50);
  EXPECT_EQ(first_truth<sonar_range_t>(ranging_world("type: sonar, range_max_m: 4", wall_at(5))).valid, 0);
  EXPECT_EQ(first_truth<sonar_range_t>(ranging_world("type: sonar, range_min_m: 20", wall_at(5))).valid, 0);
  EXPECT_EQ(first_truth<sonar_range_t>(ranging_world("type: sonar", wall_at(5))).valid, 1);
}

TEST(Sonar, NoiseHasTheMeanAndTheSpreadAskedFor) {
  test::TestWorld test(
      ranging_world("type: sonar, resolution_m: 0, noise: {gaussian_std: 0.05, bias: 0.1}", wall_at(5)));
  test::Listener<sonar_range_t> reports(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(20);
  const double truth_m = truths.last().range_m;
  std::vector<double> errors;
  for (const auto& report : reports.take_all())
    if (report.valid) errors.push_back(report.range_m - truth_m);
  const auto [mean, std, count] = test::statistics(errors);
  ASSERT_GT(count, 1990);
  EXPECT_NEAR(mean, 0.1, 4 * 0.05 / std::sqrt(count));
  EXPECT_NEAR(std, 0.05, 4 * 0.05 / std::sqrt(2 * count));
}

TEST(Sonar, RangesAreRoundedToItsResolution) {
  const auto report =
      test::first_report<sonar_range_t>(ranging_world("type: sonar, resolution_m: 0.25, speckle: false", wall_at(5.1)));
  EXPECT_EQ(report.range_m, 5);
}

TEST(Sonar, SaysWhatIsWrongWithItsParameters) {
  const std::string error = test::error_of_world(
      ranging_world("type: sonar, beam_deg: 0, rays: 0, tvg: 30log, range_min_m: 60, pulse_s: 2", wall_at(5)));
  EXPECT_THAT(error, testing::HasSubstr("'beam_deg' must be > 0 and <= 180, got 0"));
  EXPECT_THAT(error, testing::HasSubstr("'rays' must be >= 1 and <= 10000, got 0"));
  EXPECT_THAT(error, testing::HasSubstr("'tvg' must be one of: none, 20log, 40log"));
  EXPECT_THAT(error, testing::HasSubstr("'range_min_m' must be < range_max_m"));
  EXPECT_THAT(error, testing::HasSubstr("'pulse_s' must be > 0 and <= 1, got 2"));
}

TEST(Altimeter, MeasuresItsHeightAboveTheGround) {
  const std::string ground = "  - {name: ground, fixed: true, position_m: [0, 0, -7], parts: [{shape: plane}]}\n";
  const auto report = first_truth<sonar_range_t>(ranging_world("type: altimeter", ground));
  EXPECT_EQ(report.valid, 1);
  EXPECT_NEAR(report.range_m, 7, 7 * 2e-4);  // the ray nearest to the axis of 64 in 20 deg is 0.9 deg off it
  // Rolled by less than half its beam it still receives the nearest point: 64 rays are 2 deg apart.
  const auto rolled = first_truth<sonar_range_t>(ranging_world("type: altimeter, rpy_deg: [8, 0, 0]", ground));
  EXPECT_NEAR(rolled.range_m, 7, 7 * 1e-3);
  EXPECT_THAT(test::error_of_world(ranging_world("type: altimeter, beam_deg: 200", ground)),
              testing::HasSubstr("'beam_deg' must be > 0 and <= 180, got 200"));
}

}  // namespace
