// SPDX-License-Identifier: BSD-3-Clause
// What surfaces, edges and weather do to a laser beam.
#include <gmock/gmock.h>

#include "shoal/planar_lidar_t.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"

namespace {

using shoal::planar_lidar_t;
using test::first_report;
using test::first_truth;
using test::ranging_world;
using test::wall_at;

std::string lidar_of(const std::string& more) {
  return "type: lidar, range_max_m: 100, " + more;
}

constexpr const char* surfaces =
    ", {name: white, laser: {reflectivity: 0.8}}, {name: grey, laser: {reflectivity: 0.2}}"
    ", {name: dark, laser: {reflectivity: 0.05}}, {name: mirror, laser: {reflectivity: 0.8, gloss: 1}}"
    ", {name: glass, transparent_to: [laser]}";

TEST(LaserReturn, ADarkWallVanishesWhereTheEquationSays) {
  const auto range_at = [](double wall_m) {
    return first_truth<planar_lidar_t>(
               ranging_world(lidar_of("beams: 1, range_at_10_percent_m: 10"), wall_at(wall_m, "dark"), surfaces))
        .ranges[0];
  };
  // 10 m sqrt(0.05 / 0.1) = 7.0711 m.
  EXPECT_NEAR(range_at(7.07), 7.07, 1e-6);
  EXPECT_EQ(range_at(7.072), 100.0f);
}

TEST(LaserReturn, AGrazingWallVanishesWhereTheEquationSays) {
  const auto scan = first_truth<planar_lidar_t>(
      ranging_world(lidar_of("beams: 181, range_at_10_percent_m: 10"), wall_at(5, "white"), surfaces));
  // 0.8 cos(i) = 0.1 (5 / (10 cos(i)))^2 at i = 71.6 deg.
  EXPECT_NEAR(scan.ranges[90 + 71], 5 / std::cos(sim::degrees_to_radians(71)), 1e-5);
  EXPECT_EQ(scan.ranges[90 + 72], 100.0f);
  EXPECT_EQ(scan.ranges[90 - 72], 100.0f);
}

TEST(LaserReturn, IntensityIsTheReflectivityTimesTheCosine) {
  const auto intensity = [](const std::string& material, std::size_t beam) {
    const auto scan = first_truth<planar_lidar_t>(
        ranging_world(lidar_of("beams: 181, intensities: true"), wall_at(5, material), surfaces));
    EXPECT_EQ(scan.nintensities, 181);
    return static_cast<double>(scan.intensities[beam]);
  };
  EXPECT_NEAR(intensity("white", 90) / intensity("grey", 90), 4, 1e-6);
  EXPECT_NEAR(intensity("grey", 90 + 60), 0.2 * 0.5, 1e-7);
  // Mirrored light comes back head-on only: exp(-(sin 10 / sin 3)^2) = 1.7e-5.
  EXPECT_NEAR(intensity("mirror", 90), 0.8, 1e-6);
  EXPECT_NEAR(intensity("mirror", 100), 0.8 * 1.65e-5, 1e-6);
}

TEST(LaserReturn, ThereAreNoIntensitiesUnlessAskedFor) {
  EXPECT_EQ(first_truth<planar_lidar_t>(ranging_world(lidar_of("beams: 3"), wall_at(5))).nintensities, 0);
}

TEST(LaserReturn, GoesThroughWhatLetsItThrough) {
  const std::string pane =
      "  - {name: pane, fixed: true, position_m: [2, 0, 0], parts: [{shape: box, size_m: [0.1, 4, 4], material: "
      "glass}]}\n";
  const auto scan = first_truth<planar_lidar_t>(ranging_world(lidar_of("beams: 1"), pane + wall_at(5), surfaces));
  EXPECT_NEAR(scan.ranges[0], 5, 1e-6);
}

TEST(LaserReturn, NoiseGrowsWithDistance) {
  for (const double wall_m : {5.0, 50.0}) {
    test::TestWorld test(
        ranging_world(lidar_of("beams: 1, range_std_m: 0.01, range_std_per_m: 0.002"), wall_at(wall_m)));
    test::Listener<planar_lidar_t> scans(test, "r1.s");
    test.run_for(20);
    std::vector<double> errors;
    for (const auto& scan : scans.take_all()) errors.push_back(scan.ranges[0] - wall_m);
    const auto [mean, std, count] = test::statistics(errors);
    ASSERT_EQ(count, 2000);
    const double expected = 0.01 + 0.002 * wall_m;
    // Four standard deviations of the estimates.
    EXPECT_NEAR(mean, 0, 4 * expected / std::sqrt(count));
    EXPECT_NEAR(std, expected, 4 * expected / std::sqrt(2 * count));
  }
}

/// A plate that covers the left half of a beam at 3 m.
std::string half_covered(double wall_m, const std::string& plate_material) {
  return "  - {name: plate, fixed: true, position_m: [3.05, 2, 0], parts: [{shape: box, size_m: [0.1, 4, 4], "
         "material: " +
         plate_material + "}]}\n" + wall_at(wall_m, "grey");
}

TEST(LaserReturn, AMixedPixelLiesBetweenTheEdgeAndWhatIsBehindIt) {
  const auto range = [](double wall_m, const std::string& plate, const std::string& more) {
    return static_cast<double>(
        first_truth<planar_lidar_t>(
            ranging_world(lidar_of("beams: 1, beam_divergence_deg: 0.5, beam_samples: 100, merge_m: 0.5" + more),
                          half_covered(wall_m, plate), surfaces))
            .ranges[0]);
  };
  // The mean weighted by power: half the beam at each.  1 % of the beam is one ray.
  EXPECT_NEAR(range(3.3, "grey", ""), 3.15, 0.3 * 0.02);
  EXPECT_NEAR(range(3.3, "white", ""), 3 + 0.3 * 0.2, 0.3 * 0.02);
  // Too far apart to be mixed.
  EXPECT_NEAR(range(5, "dark", ", returns: first"), 3, 1e-3);
  EXPECT_NEAR(range(5, "dark", ""), 5, 1e-3);
  EXPECT_NEAR(range(5, "white", ""), 3, 1e-3);
}

TEST(LaserReturn, AnEchoThatIsTooNearLeavesTheFartherOne) {
  const auto range = [](const std::string& more) {
    return static_cast<double>(
        first_truth<planar_lidar_t>(ranging_world(lidar_of("beams: 1, beam_divergence_deg: 0.5, beam_samples: 100, "
                                                           "intensities: true, returns: first" +
                                                           more),
                                                  half_covered(5, "grey"), surfaces))
            .ranges[0]);
  };
  EXPECT_NEAR(range(""), 3, 1e-3);
  EXPECT_NEAR(range(", range_min_m: 4"), 5, 1e-3);
  EXPECT_EQ(range(", range_min_m: 6"), 6);  // nothing but what is too near
}

TEST(LaserReturn, WhatIsTooNearHasNoIntensity) {
  const auto scan = first_report<planar_lidar_t>(
      ranging_world(lidar_of("beams: 1, intensities: true, range_min_m: 3, range_std_m: 0.1"), wall_at(2)));
  EXPECT_EQ(scan.ranges[0], 3.0f);
  EXPECT_EQ(scan.intensities[0], 0.0f);
}

TEST(LaserReturn, DropsAreAMeanFreePathAway) {
  test::TestWorld test(
      ranging_world(lidar_of("beams: 100, range_min_m: 0.0001, weather: {false_returns_per_m: 0.1}"), wall_at(200)));
  test::Listener<planar_lidar_t> scans(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(1);
  std::vector<double> ranges_m;
  for (const auto& scan : scans.take_all()) ranges_m.insert(ranges_m.end(), scan.ranges.begin(), scan.ranges.end());
  const auto [mean, std, count] = test::statistics(ranges_m);
  ASSERT_EQ(count, 10000);
  // Exponential with the mean 10 m, cut at 100 m (e^-10 of it); its standard deviation is its mean.
  EXPECT_NEAR(mean, 10, 4 * 10 / std::sqrt(count));
  EXPECT_NEAR(std, 10, 4 * 10 / std::sqrt(count / 2));
  for (const float range : truths.last().ranges) EXPECT_EQ(range, 100.0f);
}

TEST(LaserReturn, DropsHideAWallByTheExponentialLaw) {
  test::TestWorld test(ranging_world(lidar_of("beams: 1, weather: {false_returns_per_m: 0.1}"), wall_at(5)));
  test::Listener<planar_lidar_t> scans(test, "r1.s");
  test.run_for(20);
  double seen = 0;
  for (const auto& scan : scans.take_all()) seen += scan.ranges[0] == 5.0f;
  const double p = std::exp(-0.1 * (5 - 0.05));  // nearer than range_min_m no drop is seen
  EXPECT_NEAR(seen / 2000, p, 4 * std::sqrt(p * (1 - p) / 2000));
}

TEST(LaserReturn, FogTakesPowerBothWays) {
  const auto intensity = [](const char* weather) {
    return static_cast<double>(
        first_truth<planar_lidar_t>(ranging_world(lidar_of(std::string("beams: 1, intensities: true") + weather),
                                                  wall_at(10, "white"), surfaces))
            .intensities[0]);
  };
  EXPECT_NEAR(intensity(", weather: {extinction_per_m: 0.05}") / intensity(""), std::exp(-1.0), 1e-6);
}

TEST(LaserReturn, FaultsReachTheNoiseThatGrows) {
  test::TestWorld test(ranging_world(lidar_of("beams: 100, range_std_m: 0.01"), wall_at(5)) +
                       "events: [{name: e, at: 0, do: [{fault: {device: r1/s, kind: degraded, noise_factor: 10}}]}]\n");
  test::Listener<planar_lidar_t> scans(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(1);
  std::vector<double> errors;
  const auto truth = truths.last();
  for (const auto& scan : scans.take_all())
    for (std::size_t i = 40; i < 60; ++i) errors.push_back(scan.ranges[i] - truth.ranges[i]);
  EXPECT_NEAR(test::statistics(errors).std, 0.1, 0.01);
}

TEST(LaserReturn, ItsParametersCanChangeWhileItRuns) {
  test::TestWorld test(ranging_world(lidar_of("beams: 1"), wall_at(5, "dark"), surfaces));
  test::Listener<planar_lidar_t> scans(test, "r1.s");
  test.run_for(0.1);
  EXPECT_NEAR(scans.last().ranges[0], 5, 1e-6);
  EXPECT_EQ(test.change("r1/s", "{range_at_10_percent_m: 4}"), "");
  test.run_for(0.1);
  EXPECT_EQ(scans.last().ranges[0], 100.0f);
}

TEST(LaserReturn, SaysWhatIsWrongWithItsParameters) {
  const std::string error = test::error_of_world(ranging_world(
      lidar_of("beam_samples: 4, range_min_m: 200, preset: lms100, returns: last, weather: {extinction_per_m: -1}"),
      wall_at(5)));
  EXPECT_THAT(error, testing::HasSubstr("'beam_samples' > 1 needs the key 'beam_divergence_deg'"));
  EXPECT_THAT(error, testing::HasSubstr("'range_min_m' must be < range_max_m"));
  EXPECT_THAT(error, testing::HasSubstr("'preset' must be one of: none, lms200, lms291, utm30lx"));
  EXPECT_THAT(error, testing::HasSubstr("'returns' must be one of"));
  EXPECT_THAT(error, testing::HasSubstr("'extinction_per_m' must be >= 0 and <= 10, got -1"));
}

}  // namespace
