// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shoal/multibeam_t.hpp"
#include "shoal/side_scan_t.hpp"
#include "shoal/sonar_range_t.hpp"
#include "sim/medium/sea_water.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"

namespace {

using shoal::sonar_range_t;
using sim::degrees_to_radians;
using test::bottom_at;
using test::first_report;
using test::first_truth;
using test::marine_world;
using test::ranging_world;
using test::wall_at;

TEST(Sonar, LevelsFollowTheSonarEquation) {
  const auto level = [](double wall_m, const std::string& more) {
    return first_truth<sonar_range_t>(
               ranging_world("type: sonar, beam_deg: 4, rays: 2000, source_level_dB: 210" + more, wall_at(wall_m)))
        .strength_dB;
  };
  // Lambert -27 dB, head-on; the mean of the two-way Gaussian lobe over its -3 dB cone is (1 - 1/4) / (2 ln 2).
  const double solid_angle_sr = 2 * std::numbers::pi * (1 - std::cos(degrees_to_radians(2)));
  const double beam_dB = 10 * std::log10(solid_angle_sr * 0.75 / (2 * std::log(2.0)));
  EXPECT_NEAR(level(10, ""), 210 - 27 + beam_dB - 20, 0.01);
  EXPECT_NEAR(level(10, "") - level(40, ""), 20 * std::log10(4.0), 0.01);  // the wall fills the beam
  EXPECT_NEAR(level(10, "") - level(10, ", absorption_dBpkm: 50"), 2 * 50 * 0.01, 1e-3);
  EXPECT_NEAR(level(10, ", tvg: 40log, absorption_dBpkm: 50"), level(10, "") + 40, 1e-2);
}

TEST(Sonar, WhatIsSmallerThanItsBeamFallsWithTheFourthPower) {
  // A plate of 0.2 m; the beam of 10 deg is 1.7 m wide at 10 m.
  const auto level = [](double x_m) {
    return first_truth<sonar_range_t>(ranging_world("type: sonar, beam_deg: 10, rays: 10000",
                                                    "  - {name: plate, fixed: true, position_m: [" +
                                                        std::to_string(x_m + 0.05) +
                                                        ", 0, 0], parts: [{shape: box, size_m: [0.1, 0.2, 0.2]}]}\n"))
        .strength_dB;
  };
  // Some 110 and 28 rays on the plate: a few of them decide at its edges.
  EXPECT_NEAR(level(10) - level(20), 40 * std::log10(2.0), 1);
}

TEST(Sonar, SpeckleHasARayleighAmplitude) {
  test::TestWorld test(ranging_world("type: sonar", wall_at(5)));
  test::Listener<sonar_range_t> reports(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(50);
  const double truth_dB = truths.last().strength_dB;
  std::vector<double> amplitudes;
  for (const auto& report : reports.take_all())
    if (report.valid) amplitudes.push_back(std::pow(10, (report.strength_dB - truth_dB) / 20));
  const auto [mean, std, count] = test::statistics(amplitudes);
  ASSERT_GT(count, 4990);
  // mean / standard deviation = sqrt(pi / (4 - pi)) = 1.913; 4 standard deviations of the estimate are 0.08.
  EXPECT_NEAR(mean / std, 1.913, 0.08);
  EXPECT_NEAR(mean, std::sqrt(std::numbers::pi) / 2, 4 * 0.463 / std::sqrt(count));
}

TEST(Sonar, SoundPassesWhatLetsItThrough) {
  const std::string net =
      "  - {name: net, fixed: true, position_m: [2, 0, 0], parts: [{shape: box, size_m: [0.1, 9, 9], material: "
      "net}]}\n";
  EXPECT_NEAR(first_truth<sonar_range_t>(
                  ranging_world("type: sonar", net + wall_at(5), ", {name: net, transparent_to: [sound]}"))
                  .range_m,
              5, 1e-2);
}

const char* down = "type: altimeter, beam_deg: 2, range_max_m: 100, resolution_m: 0, speckle: false";

double sound_speed_mps() {
  test::TestWorld test(marine_world(down));
  return test.world.medium().sound_speed_mps({0, 0, -10});
}

TEST(SonarUnderWater, ItsRangeIsOffByTheSpeedOfSoundItAssumes) {
  const auto yaml = marine_world(std::string(down) + ", assumed_sound_speed_mps: 1600", "[0, 0, -10]", bottom_at(-60));
  EXPECT_NEAR(first_truth<sonar_range_t>(yaml).range_m, 50, 0.01);  // rays within 1 deg of the axis: 8 mm
  EXPECT_NEAR(first_report<sonar_range_t>(yaml).range_m, 50 * 1600 / sound_speed_mps(), 0.01);
  const auto right = marine_world(down, "[0, 0, -10]", bottom_at(-60));
  EXPECT_NEAR(first_report<sonar_range_t>(right).range_m, 50, 0.01);
  // The true speed may be given, too.
  const auto given = marine_world(std::string(down) + ", sound_speed_mps: 1450, assumed_sound_speed_mps: 1500",
                                  "[0, 0, -10]", bottom_at(-60));
  EXPECT_NEAR(first_report<sonar_range_t>(given).range_m, 50 * 1500.0 / 1450, 0.01);
}

TEST(SonarUnderWater, ItListensForATimeAndSoForARangeByTheSpeedItAssumes) {
  const auto valid = [](double bottom_m) {
    return first_report<sonar_range_t>(
               marine_world(std::string(down) + ", sound_speed_mps: 1500, assumed_sound_speed_mps: 1600", "[0, 0, -10]",
                            bottom_at(bottom_m)))
        .valid;
  };
  // 100 m by 1600 m/s are 93.75 m by 1500 m/s.
  EXPECT_EQ(valid(-103.5), 1);
  EXPECT_EQ(valid(-104), 0);
}

TEST(SonarUnderWater, MultibeamRangesAreScaledToo) {
  const auto yaml = marine_world(
      "type: multibeam, beams: 3, swath_deg: 60, sound_speed_mps: 1500, assumed_sound_speed_mps: 1530, speckle: false, "
      "resolution_m: 0",
      "[0, 0, -10]", bottom_at(-30));
  const auto truth = first_truth<shoal::multibeam_t>(yaml), report = first_report<shoal::multibeam_t>(yaml);
  ASSERT_EQ(truth.count, 3);
  EXPECT_NEAR(truth.ranges_m[1], 20, 0.01);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(report.ranges_m[i], truth.ranges_m[i] * 1.02, 1e-4);
}

TEST(SonarUnderWater, ReceivesNothingInAirUnlessItIsMadeForIt) {
  const auto valid = [](const std::string& works_in, const std::string& medium) {
    return first_truth<sonar_range_t>(marine_world(down + works_in, "[0, 0, -10]", bottom_at(-30), "", medium)).valid;
  };
  const std::string in_air = "{water: {surface_m: -40}}";
  EXPECT_EQ(valid("", in_air), 0);
  EXPECT_EQ(valid(", works_in: air", in_air), 1);
  EXPECT_EQ(valid(", works_in: air", "{water: {surface_m: 0}}"), 0);
  EXPECT_EQ(valid(", works_in: any", in_air), 1);
  EXPECT_EQ(valid("", "{}"), 1);  // a world without water does not say what it is full of
}

TEST(SonarUnderWater, RaysEndAtTheSurface) {
  // It looks up; a ceiling hangs 5 m over the water.
  const std::string ceiling =
      "[{name: ceiling, fixed: true, position_m: [0, 0, 6], parts: [{shape: box, size_m: [100, 100, 2]}]}]";
  const auto look_up = [&](const std::string& keys, const std::string& medium) {
    return first_truth<sonar_range_t>(marine_world(down + keys, "[0, 0, -10]", ceiling, "", medium, "[180, 0, 0]"));
  };
  const std::string sea = "{water: {surface_m: 0}}";
  EXPECT_EQ(look_up("", sea).valid, 0);
  EXPECT_NEAR(look_up("", "{}").range_m, 15, 0.01);
  const auto surface = look_up(", surface_echo: true", sea);
  EXPECT_EQ(surface.valid, 1);
  EXPECT_NEAR(surface.range_m, 10, 0.01);
  EXPECT_NEAR(look_up(", surface_echo: true, surface_backscatter_dB: -20", sea).strength_dB - surface.strength_dB, 10,
              1e-9);
}

TEST(SonarUnderWater, LooksUpAtTheWaves) {
  // 10 m under still water: it receives the surface as far above as the wave lifts it.  A beam of 2 degrees sees 0.35 m
  // of a wave 39 m long, whose slope is at most 0.08: the nearest of it is 14 mm off at most.
  test::TestWorld test(test::held_in_place(
      marine_world(std::string(down) + ", surface_echo: true", "[0, 0, -10]", "[]", "",
                   "{water: {}, waves: {type: regular, height_m: 1, period_s: 5, phase_deg: 0}}", "[180, 0, 0]")));
  test::Listener<sonar_range_t> truths(test, "r1.s.truth");
  test.run_for(5);
  double highest = 0, lowest = 100;
  for (const sonar_range_t& each : truths.take_all()) {
    const double t = static_cast<double>(each.utime) * 1e-6;
    ASSERT_EQ(each.valid, 1) << t;
    EXPECT_NEAR(each.range_m, 10 + 0.5 * std::cos(2 * std::numbers::pi * t / 5), 0.014) << t;
    highest = std::max(highest, each.range_m);
    lowest = std::min(lowest, each.range_m);
  }
  EXPECT_NEAR(highest - lowest, 1, 0.01);
}

TEST(SonarUnderWater, ASonarJustUnderTheSurfaceIsInAirInATrough) {
  // 0.2 m deep in waves of 0.5 m: in air while cos(wt) < -0.4, for acos(0.4) / pi of the time.
  test::TestWorld test(test::held_in_place(marine_world(
      down, "[0, 0, -0.2]", bottom_at(-20), "", "{water: {}, waves: {type: regular, height_m: 1, period_s: 5}}")));
  test::Listener<sonar_range_t> truths(test, "r1.s.truth");
  test.run_for(50);
  int deaf = 0;
  const auto all = truths.take_all();
  for (const sonar_range_t& each : all) deaf += each.valid == 0;
  // Ten waves, two changes each, a sample early or late.
  EXPECT_NEAR(deaf / static_cast<double>(all.size()), std::acos(0.4) / std::numbers::pi, 20.0 / 5000);
}

TEST(SonarUnderWater, TheWaterAbsorbsByTheFrequency) {
  const auto level_dB = [](const std::string& keys) {
    return first_truth<sonar_range_t>(marine_world(down + keys, "[0, 0, -10]", bottom_at(-60), "",
                                                   "{water: {surface_m: 0, temperature_C: 10, salinity_psu: 35}}"))
        .strength_dB;
  };
  const double loss_dB = 2 * 0.05 * sim::francois_garrison_dBpkm(200, {10, 35, 10, 8});
  EXPECT_NEAR(level_dB("") - level_dB(", frequency_kHz: 200"), loss_dB, 0.01);  // beam edges: 50.008 m
  EXPECT_NEAR(level_dB("") - level_dB(", frequency_kHz: 200, absorption_dBpkm: 10"), 2 * 0.05 * 10, 0.01);
}

TEST(SonarUnderWater, ASideScanInAirIsDark) {
  const auto brightest = [](const std::string& medium) {
    const auto lines = first_truth<shoal::side_scan_t>(
        marine_world("type: side_scan, rays: 60, bins: 64", "[0, 0, -10]", bottom_at(-20), "", medium));
    return *std::max_element(lines.port.begin(), lines.port.end());
  };
  EXPECT_GT(brightest("{water: {surface_m: 0}}"), 0);
  EXPECT_EQ(brightest("{water: {surface_m: -40}}"), 0);
}

}  // namespace
