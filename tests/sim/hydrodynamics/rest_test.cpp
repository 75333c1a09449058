// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "sim/vehicle/vehicle.hpp"
#include "tests/sim/hydrodynamics/floating_worlds.hpp"

// A body at rest in still water stays there, and energy never grows, for steps of 1 to 50 ms.

namespace {

using sim::Body;
using sim::Vector3d;
using test::TestWorld;

/// Coefficients of a BlueROV2 Heavy, REMUS 100 and Otter as in vehicles/, without what does nothing at rest.
const char* crafts = R"(
vehicles:
  - name: rov
    position_m: [0, 0, -5]
    model:
      shoal: 1
      vehicle: rov
      bodies:
        - name: hull
          hydrodynamics: {frame: frd, mass_kg: 13.5, inertia_kgm2: [0.26, 0.23, 0.37], buoyancy_N: 132.389775,
            center_of_buoyancy_m: [0, 0, -0.01], added_mass: [6.36, 7.12, 18.68, 0.189, 0.135, 0.222],
            linear_damping: [13.7, 0, 33.0, 0, 0.8, 0], quadratic_damping: [141, 217, 190, 1.19, 0.47, 1.5]}
          parts: [{shape: box, size_m: [0.4, 0.3, 0.2]}]
  - name: auv
    position_m: [0, 5, -5]
    model:
      shoal: 1
      vehicle: auv
      bodies:
        - name: hull
          hydrodynamics: {frame: frd, mass_kg: 31.900515, center_of_mass_m: [0, 0, 0.02],
            inertia_kgm2: [0.11738256, 4.22073226, 4.22073226], hull_height_m: 0.19, hull_length_m: 1.6,
            added_mass: [0.86330184, 30.29360551, 30.29360551, 0.03524912, 3.59385625, 3.59385625],
            linear_damping: [1.63819086, 3.10970604, 3.10970604, 0.61082586, 11.2056326, 7.81458851],
            hull_lift: {area_m2: 0.2128, lift_slope: 0.26599679, drag_coefficient: 0.05703920, induced_drag: 6.25},
            cross_flow: {length_m: 1.6, height_m: 0.19, drag_coefficient: [0.8]}}
          parts: [{shape: capsule, radius_m: 0.095, length_m: 1.41, rpy_deg: [0, 90, 0]}]
  - name: usv
    position_m: [0, 10, 0]
    model:
      shoal: 1
      vehicle: usv
      bodies:
        - name: hull
          hydrodynamics: {frame: frd, mass_kg: 55, center_of_mass_m: [0.2, 0, -0.2],
            inertia_kgm2: [10.26432, 13.75, 13.75], added_mass: [5.28152101, 82.5, 55, 2.052864, 11, 23.375],
            linear_damping: [77.55443248, 137.5, 546.48049, 50.02366, 218.18786, 39.325],
            quadratic_damping: [0, 0, 0, 0, 0, 393.25],
            cross_flow: {length_m: 2, height_m: 0.13414634, drag_coefficient: [0.84703524]},
            waterline: {length_m: 2, beam_m: 1.08, heave_Npm: 7541.4375, heave_pitch_N: 1508.2875,
                        roll_Nmprad: 1077.3296, pitch_Nmprad: 2853.4339}}
          parts: [{shape: box, size_m: [2, 1, 0.3]}]
)";

/// Each at its draft.
const char* floaters = R"(
objects:
  - {name: box, position_m: [10, 0, 0.05], parts: [{shape: box, size_m: [2, 1, 0.5], density_kgpm3: 410}]}
  - {name: sphere, position_m: [20, 0, 0], parts: [{shape: sphere, radius_m: 0.3, density_kgpm3: 512.5}]}
  - {name: capsule, position_m: [30, 0, 0], rpy_deg: [0, 90, 0],
     parts: [{shape: capsule, radius_m: 0.2, length_m: 1, density_kgpm3: 512.5, added_mass_coefficient: 1}]}
  - {name: neutral, position_m: [40, 0, -3], parts: [{shape: box, size_m: [1, 0.5, 0.2], density_kgpm3: 1025}]}
)";

std::string still_world(double step_s) {
  return "shoal: 1\nphysics: {step_s: " + sim::number_text(step_s) +
         ", gravity_mps2: 9.80665}\nmedium: {water: {density_kgpm3: 1025}}\n";
}

std::vector<Body*> all_bodies(TestWorld& test) {
  std::vector<Body*> bodies;
  for (const auto& vehicle : test.world.vehicles()) bodies.push_back(&vehicle->body("hull"));
  for (const auto& [name, object] : test.world.objects()) bodies.push_back(&object.base());
  return bodies;
}

TEST(Surface, ACraftOverTheWaterFallsLikeAStoneAndReachesRestInIt) {
  std::string world = still_world(0.01) + crafts;
  for (const auto& [from, to] :
       {std::pair{"[0, 0, -5]", "[0, 0, 20]"}, {"[0, 5, -5]", "[0, 5, 20]"}, {"[0, 10, 0]", "[0, 10, 20]"}})
    world.replace(world.find(from), std::string(from).size(), to);
  TestWorld test(world);
  test.run_for(1);
  for (const auto& vehicle : test.world.vehicles())
    EXPECT_NEAR(vehicle->body("hull").X_WB().translation().z(), 20 - 9.80665 / 2, 1e-6) << vehicle->name();
  test.run_for(300);
  for (const auto& vehicle : test.world.vehicles()) {
    const Body& body = vehicle->body("hull");
    EXPECT_LT(body.v_WB_W().norm(), 0.02) << vehicle->name();
    EXPECT_LT(body.X_WB().translation().z(), 0.1) << vehicle->name();
    EXPECT_GT(body.X_WB().linear()(2, 2), 0.99) << vehicle->name();
  }
}

class StillWater : public testing::TestWithParam<double> {};

// An hour; with steps of 1 ms ten minutes and with 5 ms half an hour, to save time: a drift of rounding errors grows
// with the number of steps, and that is largest there.
TEST_P(StillWater, WhatRestsStaysWhereItIs) {
  const double step_s = GetParam();
  TestWorld test(still_world(step_s) + floaters + crafts);
  const std::vector<Body*> bodies = all_bodies(test);
  ASSERT_EQ(bodies.size(), 7u);
  std::vector<sim::Pose> start;
  for (const Body* body : bodies) start.push_back(body->X_WB());
  test.run_for(step_s < 0.002 ? 600 : step_s < 0.01 ? 1800 : 3600);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const sim::Pose now = bodies[i]->X_WB();
    EXPECT_LT((now.translation() - start[i].translation()).norm(), 0.001) << bodies[i]->name();
    EXPECT_LT((now.linear() - start[i].linear()).norm(), 0.001) << bodies[i]->name();
    EXPECT_LT(bodies[i]->w_WB_W().norm(), 1e-6) << bodies[i]->name();
  }
}

/// Of a body let go at an angle and with speed: the energy of its motion, with the added mass of each.
double kinetic_energy_J(const Body& body, const Vector3d& mass_kg, const Vector3d& inertia_kgm2, const Vector3d& p_BC) {
  const sim::Matrix3d R = body.X_WB().linear().transpose();
  const Vector3d v = R * body.velocity_at_W(p_BC), w = R * body.w_WB_W();
  return (mass_kg.dot(v.cwiseAbs2()) + inertia_kgm2.dot(w.cwiseAbs2())) / 2;
}

/// Nothing but motion: a neutral body without a righting moment, so that all energy is in its speed.  Three times the
/// coupling of a real one: a long body with much added mass that tumbles.
TEST_P(StillWater, AFreeDecayOnlyLosesEnergy) {
  TestWorld test(still_world(GetParam()) + R"(
vehicles:
  - name: rov
    position_m: [0, 0, -500]
    rpy_deg: [20, -30, 0]
    model:
      shoal: 1
      vehicle: rov
      bodies:
        - name: hull
          hydrodynamics: {frame: frd, mass_kg: 13.5, inertia_kgm2: [0.26, 0.23, 0.37], buoyancy_N: 132.389775,
            added_mass: [6.36, 7.12, 18.68, 0.189, 0.135, 0.222],
            linear_damping: [13.7, 0, 33.0, 0, 0.8, 0], quadratic_damping: [141, 217, 190, 1.19, 0.47, 1.5]}
          parts: [{shape: box, size_m: [0.4, 0.3, 0.2]}]
  - name: auv
    position_m: [0, 50, -500]
    model:
      shoal: 1
      vehicle: auv
      bodies:
        - name: hull
          hydrodynamics: {frame: frd, mass_kg: 31.9, inertia_kgm2: [0.117, 4.22, 4.22],
            added_mass: [0.86, 30.3, 30.3, 0.035, 3.59, 3.59],
            linear_damping: [1.638, 3.11, 3.11, 0.611, 11.2, 7.8],
            cross_flow: {length_m: 1.6, height_m: 0.19, drag_coefficient: [0.8]}}
          parts: [{shape: capsule, radius_m: 0.095, length_m: 1.41, rpy_deg: [0, 90, 0]}]
)");
  Body &rov = test.world.vehicles()[0]->body("hull"), &auv = test.world.vehicles()[1]->body("hull");
  rov.set_velocity_W({1, 0.5, -0.5}, {0.5, 0.5, 1});
  auv.set_velocity_W({1.5, 0.2, 0.1}, {0.2, 0.3, -0.3});
  const auto energy = [&](int i) {
    return i == 0 ? kinetic_energy_J(rov, {13.5 + 6.36, 13.5 + 7.12, 13.5 + 18.68}, {0.449, 0.365, 0.592}, {0, 0, 0})
                  : kinetic_energy_J(auv, {31.9 + 0.86, 62.2, 62.2}, {0.152, 7.81, 7.81}, {0, 0, 0});
  };
  double last[2] = {energy(0), energy(1)};
  while (test.world.now() < sim::from_seconds(60)) {
    test.world.step();
    for (int i = 0; i < 2; ++i) {
      const double now = energy(i);
      ASSERT_LE(now, last[i] * (1 + 1e-12) + 1e-15) << i << " at " << sim::to_seconds(test.world.now());
      last[i] = now;
    }
  }
  EXPECT_LT(last[0], 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Steps, StillWater, testing::Values(0.001, 0.005, 0.02, 0.05),
                         [](const auto& each) { return "Of" + std::to_string(int(each.param * 1000 + 0.5)) + "ms"; });

}  // namespace
