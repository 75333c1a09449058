// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/spheroid.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "sim/hydrodynamics/coefficient_model.hpp"
#include "sim/model/hydrodynamics_config.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/fidelity/closed_forms.hpp"

namespace {

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
