// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fidelity/closed_forms.hpp"

#include <gtest/gtest.h>

#include "sim/hydrodynamics/coefficient_model.hpp"
#include "sim/model/hydrodynamics_config.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/hydrodynamics/marine_worlds.hpp"

namespace {

using sim::Vector3d;
using sim::Vector6d;

/// A body at some depth that can be pushed along.
struct Craft {
  explicit Craft(const std::string& hydrodynamics, const std::string& medium = "{water: {}}")
      : test(test::marine_world(hydrodynamics, medium)), body(test.world.vehicles()[0]->body("hull")) {}
  void run_for(double time_s, const Vector3d& force_W = Vector3d::Zero()) {
    const sim::Time end = test.world.now() + sim::from_seconds(time_s);
    while (test.world.now() < end) {
      if (!force_W.isZero(0)) body.add_force_W(force_W, body.X_WB().translation());
      test.world.step();
    }
  }
  double x() const { return body.X_WB().translation().x(); }
  double u() const { return body.v_WB_W().x(); }

  test::TestWorld test;
  sim::Body& body;
};

TEST(ClosedForms, QuadraticDragSlowsACoastingHull) {
  Craft craft(
      "{mass_kg: 30.48, inertia_kgm2: [1, 1, 1], added_mass: [0.93, 0, 0, 0, 0, 0], derivatives: {X_uu: -1.62}}");
  craft.body.set_velocity_W({1.5, 0, 0}, Vector3d::Zero());
  craft.run_for(60);
  test::expect_closed_form(craft.u(), "quadratic_coast", "", "u");
  test::expect_closed_form(craft.x(), "quadratic_coast", "", "distance");
}

TEST(ClosedForms, LinearDragStopsACoastingHull) {
  Craft craft(
      "{mass_kg: 55, inertia_kgm2: [1, 1, 1], added_mass: [5.2815, 0, 0, 0, 0, 0], "
      "linear_damping: [77.55, 0, 0, 0, 0, 0]}");
  craft.body.set_velocity_W({1.5, 0, 0}, Vector3d::Zero());
  craft.run_for(2);
  test::expect_closed_form(craft.u(), "linear_coast", "", "u");
  craft.run_for(30);
  test::expect_closed_form(craft.x(), "linear_coast", "", "distance_total");
}

TEST(ClosedForms, AForceAgainstQuadraticDragGivesTheHyperbolicTangent) {
  Craft craft(
      "{mass_kg: 13.5, inertia_kgm2: [1, 1, 1], added_mass: [6.36, 0, 0, 0, 0, 0], "
      "quadratic_damping: [141, 0, 0, 0, 0, 0]}");
  craft.run_for(1, {30, 0, 0});
  test::expect_closed_form(craft.u(), "thrust_accel_quadratic", "", "u");
  test::expect_closed_form(craft.x(), "thrust_accel_quadratic", "", "distance");
}

TEST(ClosedForms, ASubmergedHullRollsAboutItsCenterOfBuoyancy) {
  Craft craft(
      "{frame: frd, mass_kg: 30.48, weight_N: 299, center_of_mass_m: [0, 0, 0.0196], "
      "inertia_kgm2: [0.177, 3.45, 3.45], inertia_about: origin, "
      "added_mass: [0, 1e9, 1e9, 0.0704, 0, 0]}");  // held in place, to roll about the origin
  craft.body.set_velocity_W(Vector3d::Zero(), {0.01, 0, 0});
  double first = 0, before = 0.01;
  int crossings = 0;
  while (crossings < 5) {
    craft.test.world.step();
    const double p = craft.body.w_WB_W().x();
    if (before * p < 0) {
      const double at = sim::to_seconds(craft.test.world.now()) - 0.001 * p / (p - before);
      if (crossings++ == 0) first = at;
      if (crossings == 5) test::expect_closed_form((at - first) / 2, "submerged_roll_period", "", "period");
    }
    before = p;
    ASSERT_LT(craft.test.world.now(), sim::from_seconds(20));
  }
}

TEST(ClosedForms, ACurrentTakesANeutralBodyAlong) {
  Craft craft(
      "{mass_kg: 20, inertia_kgm2: [1, 1, 1], added_mass: [10, 10, 10, 0, 0, 0], "
      "linear_damping: [12, 12, 12, 0, 0, 0]}",
      "{water: {}, current: {velocity_mps: [0.4, 0, 0]}}");
  craft.run_for(10);
  test::expect_closed_form(craft.x(), "passive_drift_linear", "", "x");
}

/// The forces of an otherwise empty model on a body that moves at `nu`.
Vector6d forces_at(const Vector6d& nu, const Vector6d& added_mass) {
  sim::HydrodynamicsConfig config;
  config.mass_kg = 10;
  config.inertia_kgm2 = sim::Matrix3d::Identity();
  config.added_mass = added_mass.asDiagonal();
  const sim::CoefficientModel model(config, 9.81);
  sim::CraftState state;
  state.nu = nu;
  state.v_water.setZero();
  state.a_water.setZero();
  state.down = Vector3d::UnitZ();
  state.depth_m = 100;
  state.density_kgpm3 = 1025;
  Vector6d force = model.mass() * model.acceleration(state, Vector6d::Zero());
  force.head<3>() += 10 * nu.tail<3>().cross(nu.head<3>());  // except for those of the rigid body
  return force;
}

TEST(ClosedForms, TheMunkMomentTurnsAHullAcrossItsWay) {
  const Vector6d nu = (Vector6d() << 1.5, 0.1, 0, 0, 0, 0).finished();
  test::expect_closed_form(forces_at(nu, sim::spheroid_added_mass(0.8, 0.095, 1025))[5], "munk_moment", "", "N");
}

TEST(ClosedForms, AddedMassHasItsCoriolisForces) {
  const Vector6d nu = (Vector6d() << 0.8, 0.3, 0, 0, 0, 0.4).finished();
  const Vector6d force = forces_at(nu, (Vector6d() << 6.36, 7.12, 0, 0, 0, 0).finished());
  test::expect_closed_form(force[0], "added_mass_coriolis", "", "X");
  test::expect_closed_form(force[1], "added_mass_coriolis", "", "Y");
}

}  // namespace
