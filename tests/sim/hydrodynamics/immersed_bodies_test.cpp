// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/immersed_bodies.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "sim/hydrodynamics/immersed_volume.hpp"
#include "tests/fidelity/closed_forms.hpp"
#include "tests/sim/hydrodynamics/floating_worlds.hpp"

namespace {

using sim::Body;
using sim::Vector3d;
using test::body_of;
using test::expect_closed_form;
using test::floating_world;
using test::TestWorld;

double height(const Body& body) {
  return body.X_WB().translation().z();
}

/// Of an object dropped near its draft, with so much drag that it soon lies still.
double resting_height(const std::string& parts, const std::string& position_m) {
  TestWorld test(floating_world(parts, position_m, 0.005));
  test.run_for(60);
  return height(body_of(test));
}

double heave_period(const std::string& parts, double start_m, double rest_m) {
  TestWorld test(floating_world(parts, "[0, 0, " + std::to_string(start_m) + "]"));
  return test::period_of(test, 12, rest_m, [&] { return height(body_of(test)); });
}

TEST(Floating, ASphereLiesAtItsDraft) {
  const double z =
      resting_height("[{shape: sphere, radius_m: 0.3, density_kgpm3: 512.5, drag_coefficient: [20]}]", "[0, 0, 0.05]");
  expect_closed_form(0.3 - z, "floating_sphere", "specific_gravity=0.5", "draft");
}

TEST(Floating, ASphereHeavesWithItsPeriod) {
  const std::string sphere = "shape: sphere, radius_m: 0.3, density_kgpm3: 512.5";
  expect_closed_form(heave_period("[{" + sphere + ", added_mass_coefficient: 0}]", 0.006, 0), "floating_sphere",
                     "added_mass=0", "heave_period_small");
  expect_closed_form(heave_period("[{" + sphere + ", added_mass_coefficient: 0.5}]", 0.006, 0), "floating_sphere",
                     "added_mass=28.98", "heave_period_small");
}

TEST(Floating, ABoxLiesAtItsDraftHeavesAndRolls) {
  const std::string box = "shape: box, size_m: [2, 1, 0.5], density_kgpm3: 410, added_mass_coefficient: 0";
  const double z = resting_height("[{" + box + ", drag_coefficient: [20]}]", "[0, 0, 0.1]");
  expect_closed_form(0.25 - z, "floating_box", "specific_gravity=0.4", "draft");
  expect_closed_form(heave_period("[{" + box + "}]", 0.055, 0.05), "floating_box",
                     "specific_gravity=0.4;g=", "heave_period");
  TestWorld test(floating_world("[{" + box + "}]", "[0, 0, 0.05]", 0.001, ", rpy_deg: [2, 0, 0]"));
  const double period =
      test::period_of(test, 15, 0, [&] { return sim::rpy_from_rotation(body_of(test).X_WB().linear()).x(); });
  expect_closed_form(period, "floating_box", "added_inertia=0", "roll_period_small");
}

/// The arm between weight and buoyancy of the box of the closed forms, heeled about its water line.
double righting_arm_m(double heel_rad) {
  const sim::WaterPlane plane{{0, std::sin(heel_rad), std::cos(heel_rad)}, std::cos(heel_rad) * (0.2 - 0.25)};
  const sim::ImmersedVolume immersed = sim::immersed_box({2, 1, 0.5}, plane);
  EXPECT_NEAR(immersed.volume_m3, 2 * 1 * 0.2, 1e-12);  // wall-sided
  return std::abs(immersed.centroid_m.dot(Vector3d(0, std::cos(heel_rad), -std::sin(heel_rad))));
}

TEST(Floating, AHeeledBoxRightsItself) {
  const double small = 0.001, eight = sim::degrees_to_radians(8);
  expect_closed_form(righting_arm_m(small) / std::sin(small), "floating_box", "KG=0.25", "GM_transverse");
  expect_closed_form(1025 * 9.80665 * 0.4 * righting_arm_m(eight), "floating_box_wall_sided", "heel_deg=8",
                     "righting_moment");
}

TEST(Floating, ASparHeavesWithItsPeriod) {
  // The closed form is for 1.2 m under water; ballast that displaces nothing keeps it upright.
  const double mass_kg = 1025 * std::numbers::pi * 0.01 * 1.2;
  const auto parts = [&](const std::string& more) {
    return "[{shape: cylinder, radius_m: 0.1, length_m: 2, mass_kg: 5" + more +
           "}, {shape: sphere, radius_m: 0.05, position_m: [0, 0, -0.9], displaces: false, mass_kg: " +
           std::to_string(mass_kg - 5) + "}]";
  };
  const double rest_m = 1 - 1.2;
  expect_closed_form(heave_period(parts(", added_mass_coefficient: 0"), rest_m + 0.024, rest_m), "spar_cylinder",
                     "added_mass=0", "heave_period");
  const std::string coefficient = std::to_string(2.14675498 / mass_kg);
  expect_closed_form(heave_period(parts(", added_mass_coefficient: " + coefficient), rest_m + 0.024, rest_m),
                     "spar_cylinder", "added_mass=2.14", "heave_period");
}

TEST(Floating, AddedMassOfManyTimesTheMassIsStable) {
  // A bubble of foam: its added mass is 10 times its mass; it rises with (rho V - m) g / (m + 0.5 rho V) at first.
  TestWorld test(floating_world("[{shape: sphere, radius_m: 0.1, density_kgpm3: 51.25, added_mass_coefficient: 0.5}]",
                                "[0, 0, -20]", 0.01));
  test.world.step();
  EXPECT_NEAR(body_of(test).v_WB_W().z() / 0.01, 9.80665 * (1 - 0.05) / (0.05 + 0.5), 1e-6);
  test.run_for(60);
  EXPECT_NEAR(height(body_of(test)), 0.1, 0.05);
  EXPECT_LT(body_of(test).v_WB_W().norm(), 0.05);
}

TEST(Floating, LightFoamComesToRestThoughItsStepsChange) {
  // Some of its steps are integrated by ODE for their drag, others are those of a free body.
  for (const double density_kgpm3 : {50, 60}) {
    TestWorld test(
        floating_world("[{shape: box, size_m: [1, 0.6, 0.05], density_kgpm3: " + std::to_string(density_kgpm3) + "}]",
                       "[0, 0, 0.3]", 0.02, ", rpy_deg: [20, 35, 0]"));
    test.run_for(60);
    // Drag by the square of a velocity leaves about 0.03 m/s after a minute.
    EXPECT_LT(body_of(test).v_WB_W().norm(), 0.05) << density_kgpm3;
    EXPECT_LT(body_of(test).w_WB_W().norm(), 0.1) << density_kgpm3;
  }
}

TEST(Floating, InWavesTheStepIsOfSecondOrder) {
  const auto place_with = [](double step_s) -> Vector3d {
    TestWorld test("shoal: 1\nphysics: {step_s: " + sim::number_text(step_s) +
                   "}\nmedium: {water: {density_kgpm3: 1000}, waves: {type: regular, height_m: 1, period_s: 4}}\n"
                   "objects:\n  - {name: it, position_m: [0, 0, -2], parts: [{shape: sphere, radius_m: 0.1, "
                   "density_kgpm3: 1000}]}\n");
    test.run_for(10);
    return body_of(test).X_WB().translation();
  };
  const Vector3d coarse = place_with(0.05), half = place_with(0.025), quarter = place_with(0.0125);
  EXPECT_NEAR(std::log2((coarse - half).norm() / (half - quarter).norm()), 2, 0.2);
}

TEST(Floating, WhatDisplacesNothingFalls) {
  TestWorld test(floating_world("[{shape: sphere, radius_m: 0.3, mass_kg: 1, displaces: false}]", "[0, 0, -1]"));
  test.run_for(1);
  EXPECT_NEAR(height(body_of(test)), -1 - 9.80665 / 2, 1e-9);  // the step is exact for constant g
}

TEST(Floating, OverTheWaterNothingHappens) {
  TestWorld test(floating_world("[{shape: sphere, radius_m: 0.3, mass_kg: 1}]", "[0, 0, 10]"));
  test.run_for(1);
  EXPECT_NEAR(height(body_of(test)), 10 - 9.80665 / 2, 1e-9);
}

TEST(Floating, TheCurrentTakesItAlong) {
  TestWorld test(
      "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {}, current: [{velocity_mps: [0.5, 0, 0]}]}\nobjects:\n"
      "  - {name: it, parts: [{shape: sphere, radius_m: 0.3, density_kgpm3: 512.5}]}\n");
  test.run_for(180);
  EXPECT_NEAR(body_of(test).v_WB_W().x(), 0.5, 0.02);
}

TEST(Floating, ALightBallInLongStepsFloats) {
  TestWorld test(floating_world("[{shape: sphere, radius_m: 0.15, mass_kg: 0.05}]", "[0, 0, 0.3]", 0.05));
  test.run_for(60);
  EXPECT_NEAR(height(body_of(test)), 0.15, 0.03);
  EXPECT_LT(body_of(test).v_WB_W().norm(), 0.1);
}

}  // namespace
