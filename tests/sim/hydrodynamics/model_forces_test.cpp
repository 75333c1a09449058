// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/hydrodynamics/coefficient_model.hpp"
#include "tests/sim/hydrodynamics/marine_worlds.hpp"

namespace {

using sim::Vector6d;

constexpr double density_kgpm3 = 1000, ten_mps2 = 10;

sim::CraftState level(double depth_m) {
  sim::CraftState state;
  state.nu.setZero();
  state.v_water.setZero();
  state.a_water.setZero();
  state.down = sim::Vector3d::UnitZ();
  state.depth_m = depth_m;
  state.density_kgpm3 = density_kgpm3;
  return state;
}

sim::CoefficientModel model_of(const std::string& more) {
  return {test::config_of("{frame: frd, mass_kg: 10, inertia_kgm2: [1, 1, 1]" + more + "}"), ten_mps2};
}

/// The forces of the water on a craft deep in it.
Vector6d forces_at(const sim::CoefficientModel& model, const Vector6d& nu) {
  sim::CraftState state = level(100);
  state.nu = nu;
  return model.forces(state, nu);
}

Vector6d along(double u, double w) {
  return (Vector6d() << u, 0, w, 0, 0, 0).finished();
}

const std::string hull = ", hull_lift: {area_m2: 0.2, lift_slope: 1.5, drag_coefficient: 0.06, induced_drag: 6}";

TEST(HullLift, AHullThatGoesAsternHasNoLiftByThat) {
  const Vector6d tau = forces_at(model_of(hull), along(-2, 0));
  EXPECT_NEAR(tau[0], 0.5 * density_kgpm3 * 4 * 0.2 * 0.06, 1e-9);
  EXPECT_NEAR(tau[2], 0, 1e-9);
}

TEST(HullLift, AsternIsTheMirrorImageOfAhead) {
  const sim::CoefficientModel model = model_of(hull);
  for (const double w : {-3.0, -0.5, 0.1, 1.0, 4.0}) {
    const Vector6d ahead = forces_at(model, along(1, w)), astern = forces_at(model, along(-1, w));
    EXPECT_NEAR(astern[0], -ahead[0], 1e-9) << w;
    EXPECT_NEAR(astern[2], ahead[2], 1e-9) << w;
  }
}

TEST(HullLift, ItGrowsWithTheAngleUpToHalfARightAngleAndIsGoneAcrossTheFlow) {
  const sim::CoefficientModel model = model_of(", hull_lift: {area_m2: 0.2, lift_slope: 1.5}");
  const double pressure = 0.5 * density_kgpm3 * 0.2;
  for (const double degrees : {-40.0, 10.0, 44.0}) {
    const double alpha = degrees * std::numbers::pi / 180;
    const Vector6d tau = forces_at(model, along(std::cos(alpha), std::sin(alpha)));
    EXPECT_NEAR(tau[0], pressure * 1.5 * alpha * std::sin(alpha), 1e-9) << degrees;
    EXPECT_NEAR(tau[2], -pressure * 1.5 * alpha * std::cos(alpha), 1e-9) << degrees;
  }
  // No jump on the way to 90 degrees, where ahead becomes astern, nor there: the force of slope 1.5 times the angle,
  // at most pi / 2, falls within 45 degrees and turns, by less than 4 times 1.5 per radian.
  const double step = 1e-4;
  for (double alpha = 0.6; alpha < std::numbers::pi - 0.6; alpha += step) {
    const Vector6d here = forces_at(model, along(std::cos(alpha), std::sin(alpha))),
                   next = forces_at(model, along(std::cos(alpha + step), std::sin(alpha + step)));
    ASSERT_LT((next - here).norm(), pressure * 1.5 * 4 * step) << alpha;
  }
  EXPECT_LT(forces_at(model, along(0, 1)).norm(), 1e-9);
}

TEST(HullLift, TheDragOfTheLiftStaysAcrossTheFlow) {
  const sim::CoefficientModel model =
      model_of(", hull_lift: {area_m2: 0.2, lift_slope: 1.5, drag_coefficient: 0.06, induced_drag: 0.4}");
  const double C_L = 1.5 * std::numbers::pi / 2, C_D = 0.06 + 0.4 * C_L * C_L;
  EXPECT_NEAR(forces_at(model, along(0, 1))[2], -0.5 * density_kgpm3 * 0.2 * C_D, 1e-9);
}

/// The force of a single derivative of 2 in its row, at a motion of +0.5 and of -0.5.
void expect_forces(const std::string& name, int row, int motion, double ahead, double back) {
  const sim::CoefficientModel model = model_of(", derivatives: {'" + name + "': " + (row == motion ? "-2" : "2") + "}");
  const double sign = row == motion ? -1 : 1;
  Vector6d nu = Vector6d::Zero();
  nu[motion] = 0.5;
  EXPECT_NEAR(sign * forces_at(model, nu)[row], ahead, 1e-12) << name;
  EXPECT_NEAR(sign * forces_at(model, -nu)[row], back, 1e-12) << name;
}

TEST(Derivatives, ADoubledLetterIsASquareWhereTheForceDoesNotTurnRound) {
  expect_forces("X_vv", 0, 1, 0.5, 0.5);
  expect_forces("X_ww", 0, 2, 0.5, 0.5);
  expect_forces("X_qq", 0, 4, 0.5, 0.5);
  expect_forces("X_rr", 0, 5, 0.5, 0.5);
  expect_forces("Z_rr", 2, 5, 0.5, 0.5);
  expect_forces("M_vv", 4, 1, 0.5, 0.5);
  expect_forces("N_uu", 5, 0, 0.5, 0.5);
}

TEST(Derivatives, ADoubledLetterHasTheSignOfTheMotionWhereTheForceTurnsRoundWithIt) {
  expect_forces("X_uu", 0, 0, 0.5, -0.5);
  expect_forces("Y_vv", 1, 1, 0.5, -0.5);
  expect_forces("Y_rr", 1, 5, 0.5, -0.5);
  expect_forces("K_vv", 3, 1, 0.5, -0.5);
  expect_forces("N_vv", 5, 1, 0.5, -0.5);
  expect_forces("Z_qq", 2, 4, 0.5, -0.5);
  expect_forces("M_ww", 4, 2, 0.5, -0.5);
}

TEST(Derivatives, BarsGiveTheSignOfTheMotionAnywhere) {
  expect_forces("X_|r|r", 0, 5, 0.5, -0.5);
  expect_forces("Z_v|v|", 2, 1, 0.5, -0.5);
}

/// What pushes a level craft ahead when the water around it accelerates with 0.5 m/s^2.
double carried_along_N(const std::string& more, double depth_m) {
  const sim::CoefficientModel model = model_of(more);
  sim::CraftState state = level(depth_m);
  state.a_water.x() = 0.5;
  return (model.mass() * model.acceleration(state, Vector6d::Zero()))[0];
}

TEST(Waves, AcceleratedWaterPushesWithTheMassThatTheCraftDisplaces) {
  EXPECT_NEAR(carried_along_N("", 100), 10 * 0.5, 1e-9);
  EXPECT_NEAR(carried_along_N(", buoyancy_N: 50", 100), 5 * 0.5, 1e-9);
  EXPECT_NEAR(carried_along_N(", volume_m3: 0.004", 100), 4 * 0.5, 1e-9);
  EXPECT_NEAR(carried_along_N(", volume_m3: 0.004, added_mass: [2, 0, 0, 0, 0, 0]", 100), (4 + 2) * 0.5, 1e-9);
  const std::string floats = ", waterline: {heave_Npm: 500, roll_Nmprad: 50, pitch_Nmprad: 50}, buoyancy_N: 50";
  EXPECT_NEAR(carried_along_N(floats, 0), 10 * 0.5, 1e-9);
}

}  // namespace
