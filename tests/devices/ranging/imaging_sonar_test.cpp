// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/imaging_sonar.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "shoal/sonar_image_t.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"

namespace {

using shoal::sonar_image_t;
using sim::degrees_to_radians;
using test::first_truth;
using test::ranging_world;
using test::wall_at;

std::string bottom(double roll_deg) {
  return "  - {name: bottom, fixed: true, position_m: [0, 0, -20], rpy_deg: [" + std::to_string(roll_deg) +
         ", 0, 0], parts: [{shape: plane}]}\n";
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

}  // namespace
