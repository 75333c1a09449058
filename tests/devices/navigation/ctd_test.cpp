// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/ctd_t.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using shoal::ctd_t;
using test::marine_world;

TEST(Ctd, StandardSeaWaterHasTheStandardConductivity) {
  // 35 psu, 15 C: 4.2914 S/m without pressure (UNESCO 44); without weight there is none.
  const auto report = test::first_truth<ctd_t>(marine_world(
      "type: ctd", "[0, 0, -10]", "[]", "", "{water: {surface_m: 0, temperature_C: 15, salinity_psu: 35}}"));
  EXPECT_EQ(report.valid, 1);
  EXPECT_NEAR(report.temperature_C, 15, 1e-9);
  EXPECT_NEAR(report.salinity_psu, 35, 1e-6);
  EXPECT_NEAR(report.conductivity_Spm, 4.2914, 1e-5);
}

TEST(Ctd, ReportsTheSpeedOfSoundOfTheMedium) {
  // closed_forms.csv: Mackenzie at 10 C and 35 psu 1489.80 m/s, UNESCO 1489.82; 10 m deeper 0.16 m/s more.
  const auto report = test::first_truth<ctd_t>(marine_world(
      "type: ctd", "[0, 0, -10]", "[]", "", "{water: {surface_m: 0, temperature_C: 10, salinity_psu: 35}}"));
  EXPECT_NEAR(report.sound_speed_mps, 1489.8 + 0.163, 0.2);
}

TEST(Ctd, AnErrorOfConductivityIsOneOfSalinity) {
  const auto report =
      test::first_report<ctd_t>(marine_world("type: ctd, conductivity_noise: {scale_error: 0.01}", "[0, 0, -10]", "[]",
                                             "", "{water: {surface_m: 0, temperature_C: 15, salinity_psu: 35}}"));
  // At 15 C d ln S / d ln R = sum(i/2 a_i) / 35 = 1.1189; the square adds less than 0.005.
  EXPECT_NEAR(report.salinity_psu, 35 * (1 + 0.01 * 1.1189), 5e-3);
}

TEST(Ctd, IsInvalidInAirAndInADryWorld) {
  for (const char* medium : {"{water: {surface_m: -20}}", "{}"}) {
    const auto report = test::first_report<ctd_t>(marine_world(
        "type: ctd, conductivity_noise: {bias: 1}, sound_speed_noise: {bias: 3}", "[0, 0, -10]", "[]", "", medium));
    EXPECT_EQ(report.valid, 0) << medium;
    EXPECT_EQ(report.conductivity_Spm, 0) << medium;
    EXPECT_EQ(report.salinity_psu, 0) << medium;
    EXPECT_EQ(report.sound_speed_mps, 0) << medium;
  }
}

TEST(Ctd, NoiseHasTheSpreadAskedFor) {
  test::TestWorld test(marine_world("type: ctd, temperature_noise: {gaussian_std: 0.02}"));
  test::Listener<ctd_t> reports(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(20);
  std::vector<double> errors;
  const double truth_C = truths.last().temperature_C;
  for (const auto& report : reports.take_all()) errors.push_back(report.temperature_C - truth_C);
  const auto [mean, std, count] = test::statistics(errors);
  EXPECT_NEAR(mean, 0, 4 * 0.02 / std::sqrt(count));
  EXPECT_NEAR(std, 0.02, 4 * 0.02 / std::sqrt(2 * count));
}

TEST(Ctd, RefusesANegativeGravity) {
  EXPECT_THAT(test::error_of_world(marine_world("type: ctd, assumed_gravity_mps2: -9.8")),
              testing::HasSubstr("device 's': 'assumed_gravity_mps2' must be >= 0.1 and <= 100, got -9.8"));
}

}  // namespace
