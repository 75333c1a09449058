// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/sound_ranges.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "autonomy/cooperative/driver/nav_team.hpp"

namespace {

using namespace navigation;

/// `rows`: of the profile; empty: none.
SoundRanges ranges_in(const std::string& rows) {
  const std::string water = rows.empty() ? "sound_speed_mps: 1500" : "profile: [" + rows + "]";
  return team_of_text("shoal: 1\nname: sea\nmedium: {water: {" + water + R"(}}
vehicles:
  - name: auv
    model:
      shoal: 1
      bodies: [{name: hull, kinematic: true, parts: [{shape: sphere, radius_m: 0.1}]}]
      devices: [{name: modem, type: acoustic_modem}]
)")
      .sound;
}

/// Mixed layer over a thermocline.
SoundRanges ranges_over_thermocline() {
  return ranges_in(
      "{depth_m: 0, temperature_C: 18, salinity_psu: 35}, {depth_m: 20, temperature_C: 18, salinity_psu: 35}, "
      "{depth_m: 40, temperature_C: 8, salinity_psu: 35}, {depth_m: 200, temperature_C: 8, salinity_psu: 35}");
}

/// Thermocline that begins at the surface.
SoundRanges ranges_with_shadow() {
  return ranges_in(
      "{depth_m: 0, temperature_C: 18, salinity_psu: 35}, {depth_m: 20, temperature_C: 8, salinity_psu: 35}, "
      "{depth_m: 80, temperature_C: 8, salinity_psu: 35}");
}

TEST(SoundRanges, StraightLinesTakeTheHarmonicMeanOfTheSpeed) {
  const SoundRanges ranges = ranges_in(
      "{depth_m: 0, temperature_C: 20, salinity_psu: 35}, {depth_m: 100, temperature_C: 5, salinity_psu: 35}");
  const double top = ranges.mean_speed_mps(0, 0), bottom = ranges.mean_speed_mps(100, 100);
  EXPECT_NEAR(top, 1521, 2);  // 20 C, 35 psu
  EXPECT_LT(ranges.mean_speed_mps(0, 100), top);
  EXPECT_GT(ranges.mean_speed_mps(0, 100), bottom);
  EXPECT_EQ(ranges.mean_speed_mps(100, 0), ranges.mean_speed_mps(0, 100));
  EXPECT_EQ(ranges.mean_speed_mps(-1, -1), top);  // above the surface
  EXPECT_EQ(ranges.mean_speed_mps(1e6, 1e6), ranges.mean_speed_mps(1e7, 1e7));
  EXPECT_EQ(ranges.range_m(SoundModel::straight, 0.5, 0, 100), 0.5 * ranges.mean_speed_mps(0, 100));
}

TEST(SoundRanges, RaysInWaterOfOneSpeedAreStraight) {
  const SoundRanges ranges = ranges_in("");
  for (const double time_s : {0.1, 1.0, 3.0})
    EXPECT_NEAR(*ranges.range_m(SoundModel::rays, time_s, 1, 50), 1500 * time_s, 1e-3);
}

TEST(SoundRanges, RaysThroughAThermoclineAgreeWithBellhop) {
  // Times of BELLHOP with steps of 0.5 m in layers with these speeds, from 1 m to 50 m of depth.
  const auto row = [](const char* depth_m, const char* speed_mps) {
    return std::string("{depth_m: ") + depth_m +
           ", temperature_C: 10, salinity_psu: 35, sound_speed_mps: " + speed_mps + "}";
  };
  const SoundRanges ranges = ranges_in(row("0", "1515.80") + ", " + row("20", "1516.12") + ", " + row("40", "1483.07") +
                                       ", " + row("200", "1485.68"));
  const std::pair<double, double> level_m_and_ms[] = {
      {100, 74.10549}, {500, 333.46289}, {1000, 663.03492}, {2000, 1322.57724}};
  for (const auto& [level_m, time_ms] : level_m_and_ms)  // 0.1 us of sound, and the tolerance of the layers
    EXPECT_NEAR(*ranges.range_m(SoundModel::rays, 1e-3 * time_ms, 1, 50), std::hypot(level_m, 49), 5e-3) << level_m;
}

TEST(SoundRanges, StraightLinesAreFiveMetersWrongAtAKilometerBelowAThermocline) {
  const SoundRanges ranges = ranges_over_thermocline();
  const double time_s = 0.66303491;  // 1 km
  const double rays_m = *ranges.range_m(SoundModel::rays, time_s, 1, 50);
  EXPECT_NEAR(rays_m, std::hypot(1000, 49), 0.1);
  EXPECT_NEAR(rays_m - *ranges.range_m(SoundModel::straight, time_s, 1, 50), 5, 0.2);
  EXPECT_NEAR(*ranges.range_m(SoundModel::rays, time_s, 50, 1), rays_m, 1e-6);  // the other way
}

TEST(SoundRanges, AnEchoInAShadowIsNoRange) {
  const SoundRanges ranges = ranges_with_shadow();
  const double speed_mps = ranges.mean_speed_mps(1, 50);
  // At 300 m the straight line is 0.33 m wrong.
  const double lit_m = std::hypot(300, 49);
  EXPECT_NEAR(*ranges.range_m(SoundModel::rays, lit_m / speed_mps, 1, 50), lit_m + 0.33, 0.05);
  // Off the bottom, 12.4, 10.2 and 20.8 m too far.
  for (const auto& [level_m, more_m] : {std::pair{400.0, 12.4}, {500.0, 10.2}, {1000.0, 20.8}})
    EXPECT_EQ(ranges.range_m(SoundModel::rays, (std::hypot(level_m, 49) + more_m) / speed_mps, 1, 50), std::nullopt)
        << level_m;
}

TEST(SoundRanges, TimesShorterThanTheVerticalAreStraight) {
  const SoundRanges ranges = ranges_over_thermocline();
  for (const double time_s : {-0.01, 0.0, 0.02})
    EXPECT_EQ(ranges.range_m(SoundModel::rays, time_s, 0, 50), time_s * ranges.mean_speed_mps(0, 50));
}

}  // namespace
