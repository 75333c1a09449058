// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "shoal/actuator_command_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

const char* bluerov2 = R"(
shoal: 1
physics: {step_s: STEP, gravity_mps2: 9.82}
medium: {water: {density_kgpm3: 1000}}
vehicles:
  - name: rov
    position_m: [0, 0, -5]
    rpy_deg: [0, 0, 90]
    model:
      shoal: 1
      vehicle: bluerov2
      bodies:
        - name: hull
          hydrodynamics:
            frame: frd
            mass_kg: 13.5
            inertia_kgm2: [0.26, 0.23, 0.37]
            volume_m3: 0.0134
            center_of_buoyancy_m: [0, 0, -0.01]
            added_mass: [6.36, 7.12, 18.68, 0.189, 0.135, 0.222]
            linear_damping: [13.7, 0, 33.0, 0, 0.8, 0]
            quadratic_damping: [141, 217, 190, 1.19, 0.47, 1.5]
          parts: [{shape: box, size_m: [0.4, 0.3, 0.2]}]
)";

double rms_against(const std::string& file, const std::string& step) {
  std::string yaml = bluerov2;
  yaml.replace(yaml.find("STEP"), 4, step);
  test::TestWorld test(yaml);
  sim::Body& body = test.world.vehicles()[0]->body("hull");
  std::ifstream in(test_support::source_path("tests/fidelity/reference/") + file);
  std::string line;
  std::getline(in, line);
  double sum = 0;
  int count = 0;
  sim::Vector3d force = sim::Vector3d::Zero(), torque = sim::Vector3d::Zero();
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream values(line);
    double v[19];
    for (double& x : v) values >> x;
    while (sim::to_seconds(test.world.now()) < v[0] - 1e-9) {
      const sim::Matrix3d R = body.X_WB().linear();
      const auto flip = [](const sim::Vector3d& a) { return sim::Vector3d(a.x(), -a.y(), -a.z()); };
      body.add_force_W(R * flip(force), body.X_WB().translation());
      body.add_torque_W(R * flip(torque));
      test.world.step();
    }
    const sim::Vector3d p = body.X_WB().translation();
    sum += (sim::Vector3d(p.y(), p.x(), -p.z()) - sim::Vector3d(v[1], v[2], v[3])).squaredNorm();
    ++count;
    force = {v[13], v[14], v[15]};
    torque = {v[16], v[17], v[18]};
  }
  return std::sqrt(sum / count);
}

TEST(CoefficientModel, MovesABlueRov2AsPublishedAndHalfTheStepIsHalfTheError) {
  const double coarse = rms_against("bluerov2h_steps.csv", "0.01"), fine = rms_against("bluerov2h_steps.csv", "0.005");
  EXPECT_LT(fine, 0.01);
  EXPECT_NEAR(coarse / fine, 2, 0.2);
}

TEST(CoefficientModel, ARemusGoesAsternUntilItsThrustIsItsDrag) {
  test::TestWorld test(
      "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {density_kgpm3: 1025}}\n"
      "vehicles: [{name: auv, file: remus100.yaml, position_m: [0, 0, -50]}]\n");
  test.send("auv.propeller.cmd", shoal::actuator_command_t{0, -1000});
  test.run_for(60);
  const sim::Body& body = test.world.vehicles()[0]->body("hull");
  // Astern its propeller has the thrust of standing water, K_T0 0.4566, less the deduction of a tenth.
  const double thrust_N = 0.9 * 0.4566 * 1025 * std::pow(0.14, 4) * std::pow(1000.0 / 60, 2);
  const double speed_mps = std::sqrt(thrust_N / (0.5 * 1025 * 0.2128 * 0.0570392));
  EXPECT_NEAR((body.X_WB().linear().transpose() * body.v_WB_W()).x(), -speed_mps, 0.01 * speed_mps);
}

/// A BlueROV2 that is pressed on the bottom with 20 N beyond its buoyancy and pushed ahead: its speed after 10 s.
double speed_on_the_bottom_mps(double push_N) {
  test::TestWorld test(
      "shoal: 1\nphysics: {step_s: 0.005}\nmedium: {water: {}}\ncontacts: [{between: [any, any], friction: 0.5}]\n"
      "objects: [{name: bottom, fixed: true, position_m: [0, 0, -10], parts: [{shape: plane}]}]\n"
      "vehicles: [{name: rov, file: bluerov2.yaml, position_m: [0, 0, -9.87]}]\n");
  sim::Body& body = test.world.vehicles()[0]->body("frame");
  while (test.world.now() < sim::from_seconds(10)) {
    const double push_now_N = test.world.now() < sim::from_seconds(5) ? 0 : push_N;
    body.add_force_W({push_now_N, 0, -22}, body.X_WB().translation());
    test.world.step();
  }
  return body.v_WB_W().norm();
}

// The limit that docs/models/marine.md gives: friction compares the acceleration along, of 17 kg, with mu times that
// down, of 26.07 kg, so that it slips at 0.5 * 20 / 26.07 * 17 = 6.5 N.
TEST(CoefficientModel, FrictionOnTheBottomHoldsByAccelerations) {
  EXPECT_LT(speed_on_the_bottom_mps(6.2), 0.001);
  EXPECT_GT(speed_on_the_bottom_mps(6.9), 0.01);
}

}  // namespace
