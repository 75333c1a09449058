// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/hydrodynamics_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "sim/hydrodynamics/coefficient_model.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/fidelity/closed_forms.hpp"
#include "tests/sim/hydrodynamics/marine_worlds.hpp"

namespace {

using testing::HasSubstr;

std::string error_of(const std::string& more, const std::string& step_s = "0.001") {
  return test::error_of_world(test::marine_world("{frame: frd, mass_kg: 10" + more + "}", "{water: {}}", "", step_s));
}

const std::string inertia = ", inertia_kgm2: [1, 1, 1]";

TEST(HydrodynamicsChecks, AnInertiaIsSymmetricAlsoWithoutCoefficients) {
  EXPECT_THAT(error_of(", model: none, inertia_kgm2: [1, 0.5, 0, 0, 1, 0, 0, 0, 1]"),
              HasSubstr("'inertia_kgm2' must be symmetric"));
}

TEST(HydrodynamicsChecks, GoodCoefficientsPass) {
  EXPECT_EQ(error_of(inertia + ", added_mass: [1, 10, 10, 0.1, 1, 1], linear_damping: [1, 2, 3, 1, 1, 1]"), "");
}

TEST(HydrodynamicsChecks, MatricesHaveTheirShape) {
  EXPECT_THAT(error_of(inertia + ", added_mass: [1, 2, 3]"),
              HasSubstr("'added_mass' must have 6 numbers (the diagonal) or 36 (row by row), got 3"));
  EXPECT_THAT(
      error_of(inertia + ", added_mass: [1, 1, 1, 0, 0, 0], added_mass_of_spheroid: {half_length_m: 1, radius_m: 0.1}"),
      HasSubstr("only one of 'added_mass' and 'added_mass_of_spheroid'"));
  EXPECT_THAT(error_of(inertia + ", added_mass_of_spheroid: {half_length_m: 0.1, radius_m: 1}"),
              HasSubstr("'radius_m' must be <= 'half_length_m' 0.1, got 1"));
}

TEST(HydrodynamicsChecks, AStepTooLongForStiffForcesIsRefused) {
  // 100 N s/m on 10 kg: it needs a step below 2 * 10 / 1000 s.
  EXPECT_THAT(error_of(inertia + ", linear_damping: [1000, 0, 0, 0, 0, 0]", "0.05"),
              HasSubstr("the forces of linear damping are too stiff for 'step_s' 0.05: they need a step below 0.02 s"));
  EXPECT_EQ(error_of(inertia + ", linear_damping: [1000, 0, 0, 0, 0, 0]", "0.01"), "");
  // Roll at sqrt(1e5 / 10) = 100 rad/s.
  EXPECT_THAT(error_of(", inertia_kgm2: [10, 1000, 1000], waterline: {heave_Npm: 1, roll_Nmprad: 1e5, pitch_Nmprad: 1}",
                       "0.05"),
              HasSubstr("the restoring forces are too stiff for 'step_s' 0.05: they need a step below 0.02 s"));
}

TEST(HydrodynamicsChecks, BuoyancyIsGivenInOneWay) {
  EXPECT_THAT(error_of(inertia + ", buoyancy_N: 100, volume_m3: 0.01", "0.01"),
              HasSubstr("needs either 'buoyancy_N' or 'volume_m3', not both"));
}

using sim::Vector6d;

TEST(ClosedForms, AddedMassOfASpheroid) {
  const Vector6d added = sim::spheroid_added_mass(0.8, 0.095, 1025);
  test::expect_closed_form(added[0], "prolate_spheroid_added_mass", "", "A11");
  test::expect_closed_form(added[1], "prolate_spheroid_added_mass", "", "A22");
  test::expect_closed_form(added[4], "prolate_spheroid_added_mass", "", "A55");
  EXPECT_EQ(added[1], added[2]);
  EXPECT_EQ(added[4], added[5]);
  EXPECT_EQ(added[3], 0);
}

TEST(ClosedForms, AddedMassOfABallIsHalfItsWater) {
  const double half = 2.0 / 3 * std::numbers::pi * 1000;
  // Nearly a ball by the formula, and a ball.
  EXPECT_NEAR(sim::spheroid_added_mass(1.001, 1, 1000)[0], half, 0.002 * half);
  EXPECT_NEAR(sim::spheroid_added_mass(1, 1, 1000)[0], half, 1e-9 * half);
  EXPECT_NEAR(sim::spheroid_added_mass(1.0001, 1, 1000)[2], half, 0.001 * half);
}

}  // namespace
