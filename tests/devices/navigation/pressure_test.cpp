// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/pressure.hpp"

#include <gmock/gmock.h>

#include "shoal/pressure_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using shoal::pressure_t;
using test::marine_world;

/// With gravity, which the box follows: 0.5 g t^2 = 0.5 mm in the first step.
std::string with_gravity(std::string yaml) {
  const std::string none = "gravity_mps2: 0";
  return yaml.replace(yaml.find(none), none.size(), "gravity_mps2: 9.80665");
}

constexpr double fall_m = 9.80665 * 0.01 * 0.01;  // of ODE in one step of 10 ms

TEST(Pressure, IsTheHydrostaticPressureAtItsDepth) {
  // closed_forms.csv, hydrostatic_pressure: 25 m, 1025 kg/m^3.
  const auto yaml = with_gravity(
      marine_world("type: pressure", "[3, 4, -25]", "[]", "", "{water: {surface_m: 0, density_kgpm3: 1025}}"));
  const auto report = test::first_truth<pressure_t>(yaml);
  // The reference's tolerance of 1e-4 is 35 Pa; 1 mm of fall is 10 Pa.
  EXPECT_NEAR(report.pressure_Pa, 352620.4062, 1e-4 * 352620.4062);
  EXPECT_NEAR(report.depth_m, 25, 2 * fall_m);
}

TEST(Pressure, IsThatOfTheAirAboveTheWaterAndInADryWorld) {
  for (const char* medium : {"{water: {surface_m: 0}}", "{}"}) {
    const auto report =
        test::first_truth<pressure_t>(with_gravity(marine_world("type: pressure", "[0, 0, 1]", "[]", "", medium)));
    EXPECT_NEAR(report.pressure_Pa, 101325, 20) << medium;  // 1 m of air is 12 Pa
    EXPECT_NEAR(report.depth_m, 0, 2e-3) << medium;
  }
}

TEST(Pressure, NoiseHasTheSpreadAskedForAndAFaultShiftsIt) {
  test::TestWorld test(marine_world("type: pressure, pressure_noise: {gaussian_std: 300}"));
  test::Listener<pressure_t> reports(test, "r1.s"), truths(test, "r1.s.truth");
  test.run_for(20);
  const double truth_Pa = truths.last().pressure_Pa;
  std::vector<double> errors;
  for (const auto& report : reports.take_all()) errors.push_back(report.pressure_Pa - truth_Pa);
  const auto [mean, std, count] = test::statistics(errors);
  ASSERT_EQ(count, 2000);
  EXPECT_NEAR(mean, 0, 4 * 300 / std::sqrt(count));
  EXPECT_NEAR(std, 300, 4 * 300 / std::sqrt(2 * count));
  sim::FaultConfig fault;
  fault.kind = sim::FaultKind::biased;
  fault.quantity = "pressure";
  fault.bias = 1e5;
  test.world.editor().set_fault("r1/s", fault);
  test.run_for(0.1);
  EXPECT_NEAR(reports.last().pressure_Pa - truth_Pa, 1e5, 6 * 300);
}

using shoal::pressure_t;
using test::marine_world;

/// With gravity, which the box follows: 0.5 g t^2 = 0.5 mm in the first step.
TEST(Pressure, DepthIsOffByTheDensityItAssumes) {
  const auto yaml = with_gravity(marine_world("type: pressure, assumed_density_kgpm3: 1000", "[0, 0, -100]", "[]", "",
                                              "{water: {surface_m: 0, density_kgpm3: 1025}}"));
  // The medium may make the water denser with depth: by less than 0.1 % at 100 m.
  EXPECT_NEAR(test::first_truth<pressure_t>(yaml).depth_m, 102.5, 0.1);
}

TEST(Pressure, RefusesAnAssumedDensityOfAir) {
  EXPECT_THAT(test::error_of_world(marine_world("type: pressure, assumed_density_kgpm3: 1.2")),
              testing::HasSubstr("device 's': 'assumed_density_kgpm3' must be >= 500 and <= 2000, got 1.2"));
}

}  // namespace
