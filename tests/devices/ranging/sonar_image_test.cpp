// SPDX-License-Identifier: BSD-3-Clause
// Sonars that make swaths and images: multibeam, imaging sonar, side scan.

#include <gmock/gmock.h>

#include <algorithm>

#include "shoal/multibeam_t.hpp"
#include "shoal/side_scan_t.hpp"
#include "shoal/sonar_image_t.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"

namespace {

using shoal::multibeam_t;
using shoal::side_scan_t;
using shoal::sonar_image_t;
using sim::degrees_to_radians;
using test::first_truth;
using test::ranging_world;
using test::wall_at;

std::string bottom(double roll_deg) {
  return "  - {name: bottom, fixed: true, position_m: [0, 0, -20], rpy_deg: [" + std::to_string(roll_deg) +
         ", 0, 0], parts: [{shape: plane}]}\n";
}

TEST(Multibeam, MeasuresFlatAndSlopedBottomsAsTheClosedFormSays) {
  for (const double slope_deg : {0.0, 10.0}) {
    const auto ping = first_truth<multibeam_t>(
        ranging_world("type: multibeam, beams: 121, swath_deg: 120, range_max_m: 100", bottom(slope_deg)));
    ASSERT_EQ(ping.count, 121);
    EXPECT_NEAR(ping.angles_rad[0], degrees_to_radians(-60), 1e-6);
    const double slope = degrees_to_radians(slope_deg);
    for (int i = 0; i < ping.count; ++i) {
      ASSERT_EQ(ping.valid[i], 1) << i;
      const double off = ping.angles_rad[i] - slope;
      const double expected_m = 20 * std::cos(slope) / std::cos(off);
      // The mean over a beam 1 deg wide is off by about 3 tan^2(off) var, var = (1 deg)^2 / 24 with its taper.
      const double variance = std::pow(degrees_to_radians(1), 2) / 12;
      EXPECT_NEAR(ping.ranges_m[i], expected_m, expected_m * 4 * variance * (1 + std::pow(std::tan(off), 2)));
    }
  }
}

TEST(Multibeam, NoiseHasTheMeanAndTheSpreadAskedFor) {
  test::TestWorld test(
      ranging_world("type: multibeam, beams: 20, resolution_m: 0, noise: {gaussian_std: 0.1, bias: 0.2}", bottom(0)));
  test::Listener<multibeam_t> reports(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(3);
  const auto truth = truths.last();
  std::vector<double> errors;
  for (const auto& ping : reports.take_all())
    for (std::size_t i = 0; i < 20; ++i)
      if (ping.valid[i]) errors.push_back(ping.ranges_m[i] - truth.ranges_m[i]);
  const auto [mean, std, count] = test::statistics(errors);
  ASSERT_GT(count, 5500);
  EXPECT_NEAR(mean, 0.2, 4 * 0.1 / std::sqrt(count));
  EXPECT_NEAR(std, 0.1, 4 * 0.1 / std::sqrt(2 * count));
}

TEST(Multibeam, BeamsThatReceiveNothingSaySo) {
  const auto ping =
      first_truth<multibeam_t>(ranging_world("type: multibeam, beams: 3, swath_deg: 120, range_max_m: 30", bottom(0)));
  EXPECT_THAT(ping.valid, testing::ElementsAre(0, 1, 0));  // 40 m at 60 deg
  EXPECT_EQ(ping.ranges_m[0], 30.0f);
}

TEST(Multibeam, SaysWhatIsWrongWithItsParameters) {
  const std::string error = test::error_of_world(
      ranging_world("type: multibeam, beams: 0, swath_deg: 200, across_deg: 0, gate: 2", bottom(0)));
  EXPECT_THAT(error, testing::HasSubstr("'beams' must be >= 1 and <= 2048, got 0"));
  EXPECT_THAT(error, testing::HasSubstr("'swath_deg' must be >= 0 and <= 180, got 200"));
  EXPECT_THAT(error, testing::HasSubstr("'across_deg' must be > 0 and <= 30, got 0"));
  EXPECT_THAT(error, testing::HasSubstr("'gate' must be >= 0 and <= 1, got 2"));
  EXPECT_THAT(
      test::error_of_world(ranging_world("type: multibeam, beams: 2048, across_rays: 50, along_rays: 50", bottom(0))),
      testing::HasSubstr("'beams' x 'across_rays' x 'along_rays' must be at most 1000000 rays in a sample, got "
                         "2048 x 50 x 50 = 5120000"));
}

TEST(Multibeam, TakesTheLoudestStretchOfManyEchoes) {
  // Half of each beam meets a plate at 10 m, the rest the bottom at 20 m: power falls with the square of the range.
  const std::string plate =
      "  - {name: plate, fixed: true, position_m: [5, 0, -10.5], parts: [{shape: box, size_m: [10, 100, 1]}]}\n";
  const std::string one_beam =
      "type: multibeam, beams: 1, across_deg: 10, along_deg: 10, across_rays: 50, along_rays: 50, resolution_m: 0";
  const auto range = [&](const std::string& more) {
    return first_truth<multibeam_t>(ranging_world(one_beam + more, bottom(0) + plate)).ranges_m[0];
  };
  // Within a beam of 10 deg ranges grow by up to 0.4 %.
  EXPECT_NEAR(range(", gate: 0.1"), 10, 0.04);
  EXPECT_NEAR(range(", gate: 1, pulse_s: 0.1"), (10 + 20 / 4.0) / (1 + 1 / 4.0), 0.06);
}

TEST(ImagingSonar, APoleIsBrightAtItsRangeAndBearing) {
  const double bearing = degrees_to_radians(30);
  const std::string pole = "  - {name: pole, fixed: true, position_m: [" + std::to_string(8 * std::cos(bearing)) +
                           ", " + std::to_string(8 * std::sin(bearing)) +
                           ", 0], parts: [{shape: cylinder, radius_m: 0.1, length_m: 6}]}\n";
  const auto image = first_truth<sonar_image_t>(ranging_world(
      "type: imaging_sonar, beams: 91, fov_deg: 90, bins: 200, range_min_m: 0.1, range_max_m: 20.1", pole));
  ASSERT_EQ(image.size, 91 * 200);
  const auto brightest = std::max_element(image.data.begin(), image.data.end()) - image.data.begin();
  EXPECT_NEAR(image.rad0 + static_cast<float>(brightest % 91) * image.radstep, bearing, degrees_to_radians(1));
  EXPECT_NEAR(0.1 + (static_cast<double>(brightest / 91) + 0.5) * 0.1, 7.9, 0.15);  // front of the pole
  EXPECT_EQ(image.data[0], 0);
}

TEST(ImagingSonar, BackgroundHasTheLevelAndTheSpeckleAskedFor) {
  // Nothing there: background of 60 dB, TVG off.  v dB = floor + v * dB_per_count.
  test::TestWorld test(ranging_world(
      "type: imaging_sonar, beams: 64, bins: 100, tvg: none, noise_level_dB: 60, floor_dB: 0, dynamic_range_dB: 100",
      wall_at(300)));
  test::Listener<sonar_image_t> images(test, "r1.s");
  test.run_for(0.02);
  const auto image = images.last();
  std::vector<double> amplitudes;
  for (const auto value : image.data)
    amplitudes.push_back(std::pow(10, (image.floor_dB + value * image.dB_per_count - 60) / 20));
  const auto [mean, std, count] = test::statistics(amplitudes);
  ASSERT_EQ(count, 6400);
  EXPECT_NEAR(mean / std, 1.913, 0.075);  // Rayleigh; 4 standard deviations of the estimate
}

TEST(ImagingSonar, SaysWhatIsWrongWithItsParameters) {
  const std::string error = test::error_of_world(
      ranging_world("type: imaging_sonar, beams: 4096, bins: 10000, fov_deg: 0, dynamic_range_dB: 0", bottom(0)));
  EXPECT_THAT(error, testing::HasSubstr("an image must have at most 4000000 values, got 40960000"));
  EXPECT_THAT(error, testing::HasSubstr("'fov_deg' must be > 0 and <= 360, got 0"));
  EXPECT_THAT(error, testing::HasSubstr("'dynamic_range_dB' must be >= 1 and <= 200, got 0"));
  EXPECT_THAT(test::error_of_world(
                  ranging_world("type: imaging_sonar, range_min_m: 4.89, range_max_m: 4.9, bins: 1000", bottom(0))),
              testing::HasSubstr("'range_min_m' to 'range_max_m' in 'bins' steps must be at least 0.0001 m each, got "
                                 "1e-05 m"));
}

/// 10 m above the bottom, with a wall 2 m high from y = -19.9 to -20.1 m.
side_scan_t scan_of_a_wall() {
  return first_truth<side_scan_t>(ranging_world(
      "type: side_scan, bins: 400, range_max_m: 40, rays: 4000, floor_dB: 0, dynamic_range_dB: 200",
      "  - {name: bottom, fixed: true, position_m: [0, 0, -10], parts: [{shape: plane}]}\n"
      "  - {name: wall, fixed: true, position_m: [0, -20, -9], parts: [{shape: box, size_m: [40, 0.2, 2]}]}\n"));
}

TEST(SideScan, AShadowIsAsLongAsHeightAndAltitudeSay) {
  const auto scan = scan_of_a_wall();
  ASSERT_EQ(scan.nbins, 400);
  const auto bin_of = [](double ground_m, double height_m) {
    return static_cast<std::size_t>(std::hypot(ground_m, 10 - height_m) / 0.1);
  };
  // Height 2 at 20.1 m from an altitude of 10 m: 2 * 20.1 / (10 - 2) = 5.025 m of shadow on the ground.
  const std::size_t begin = bin_of(19.9, 0), end = bin_of(20.1 + 5.025, 0);
  EXPECT_EQ(end, 270u);
  // Two bins at each end: a pulse is 0.075 m long, and rays are 0.03 m apart in range there.
  for (std::size_t bin = begin + 2; bin + 2 < end; ++bin) EXPECT_EQ(scan.starboard[bin], 0) << bin;
  for (std::size_t bin = end + 2; bin < 390; ++bin) EXPECT_GT(scan.starboard[bin], 0) << bin;
  for (std::size_t bin = begin; bin < 390; ++bin) EXPECT_GT(scan.port[bin], 0) << bin;
  // The wall faces the sonar and is brighter than the ground before it.
  EXPECT_GT(scan.starboard[bin_of(19.9, 1)], scan.port[bin_of(19.9, 1)] + 5);
}

TEST(SideScan, TheWaterColumnIsDark) {
  const auto scan = scan_of_a_wall();
  for (std::size_t bin = 0; bin < 99; ++bin) EXPECT_EQ(scan.port[bin], 0) << bin;
  EXPECT_GT(scan.port[100], 0);  // 10 m: straight down
}

TEST(SideScan, SpeckleAndNoiseAreNotInTheTruth) {
  test::TestWorld test(ranging_world("type: side_scan, bins: 50, level_noise: {bias: 3}", bottom(0)));
  test::Listener<side_scan_t> reports(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(0.05);
  const auto noisy = reports.take_all(), truth = truths.take_all();
  EXPECT_EQ(truth[0].port, truth[4].port);
  EXPECT_NE(noisy[0].port, noisy[4].port);
}

TEST(SideScan, SaysWhatIsWrongWithItsParameters) {
  const std::string error = test::error_of_world(
      ranging_world("type: side_scan, along_deg: 0, depression_deg: 91, bins: 0, level_noize: {}", bottom(0)));
  EXPECT_THAT(error, testing::HasSubstr("'along_deg' must be > 0 and <= 30, got 0"));
  EXPECT_THAT(error, testing::HasSubstr("'depression_deg' must be >= 0 and <= 90, got 91"));
  EXPECT_THAT(error, testing::HasSubstr("'bins' must be >= 1 and <= 10000, got 0"));
  EXPECT_THAT(error, testing::HasSubstr("unknown key 'level_noize'"));
}

}  // namespace
