// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/side_scan.hpp"

#include <gmock/gmock.h>

#include "shoal/side_scan_t.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"

namespace {

using shoal::side_scan_t;
using test::first_truth;
using test::ranging_world;

std::string bottom(double roll_deg) {
  return "  - {name: bottom, fixed: true, position_m: [0, 0, -20], rpy_deg: [" + std::to_string(roll_deg) +
         ", 0, 0], parts: [{shape: plane}]}\n";
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
