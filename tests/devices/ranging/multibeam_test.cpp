// SPDX-License-Identifier: BSD-3-Clause
// Sonars that make swaths and images: multibeam, imaging sonar, side scan.
#include "devices/ranging/multibeam.hpp"

#include <gmock/gmock.h>

#include "shoal/multibeam_t.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"

namespace {

using shoal::multibeam_t;
using sim::degrees_to_radians;
using test::first_truth;
using test::ranging_world;

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

}  // namespace
