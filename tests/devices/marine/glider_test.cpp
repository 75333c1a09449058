// SPDX-License-Identifier: BSD-3-Clause
// The glider and the drifter of vehicles/, against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "devices/joint/moving_mass.hpp"
#include "devices/marine/buoyancy_engine.hpp"
#include "tests/devices/marine/marine_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

class DriftingVehicle : public test::TestWorld {
 public:
  DriftingVehicle(const std::string& file, const std::string& start, const std::string& current = "[0, 0, 0]",
                  const std::string& step_s = "0.01")
      : TestWorld("shoal: 1\norigin: {latitude_deg: 60, longitude_deg: 20}\nphysics: {step_s: " + step_s +
                  ", gravity_mps2: 9.81}\nmedium: {water: {density_kgpm3: 1025}, current: {velocity_mps: " + current +
                  "}}\nvehicles:\n  - {name: v, file: " + test_support::source_path("vehicles/") + file + start +
                  "}\n"),
        body(*world.vehicles()[0]->bodies()[0].second) {}
  void command(const std::string& device, double value) {
    shoal::actuator_command_t message{};
    message.value = value;
    send("v." + device + ".cmd", message);
  }
  double pitch_deg() const { return sim::radians_to_degrees(-sim::rpy_from_rotation(body.X_WB().linear()).y()); }

  sim::Body& body;
};

/// The steady glide of the published set down at an angle: angle of attack, and the net weight at a speed.
struct SteadyGlide {
  explicit SteadyGlide(double angle_rad, double speed_mps) {
    // tan(angle) = D / L: K_D a^2 - K_L tan(angle) a + K_D0 = 0, the smaller root.
    const double b = 132.5 * std::tan(angle_rad);
    attack_rad = (b - std::sqrt(b * b - 4 * 25 * 2.15)) / (2 * 25);
    const double L = 132.5 * attack_rad, D = 2.15 + 25 * attack_rad * attack_rad;
    net_weight_N = speed_mps * speed_mps * std::hypot(L, D);
    pitch_rad = -angle_rad + attack_rad;
    // Moments about y, nose up: those of the hull and of Munk (60, 5: see the test), of the 9 kg 0.05 m below the
    // middle, and of its way forward.
    const double u = speed_mps * std::cos(attack_rad), w = speed_mps * std::sin(attack_rad);
    const double water = (70.0 - 5.0) * u * w - 100 * u * w;
    const double weight = 9 * 9.81;
    mass_at_m = (water - weight * 0.05 * std::sin(pitch_rad)) / (weight * std::cos(pitch_rad));
  }
  double attack_rad, pitch_rad, net_weight_N, mass_at_m;
};

TEST(Glider, GlidesDownAndUpAsItsLiftAndDragBalance) {
  const double angle = sim::degrees_to_radians(25);
  const SteadyGlide glide(angle, 0.3);
  EXPECT_NEAR(glide.mass_at_m, 0.0198, 0.0002);  // as printed for this glide
  const double volume = glide.net_weight_N / (1025 * 9.81);
  for (const double distance : {1.0, -1.0}) {
    DriftingVehicle test("glider.yaml", ", position_m: [0, 0, -500]");
    test.command("engine", -distance * volume);
    test.command("battery", distance * glide.mass_at_m);
    test.run_for(700);
    const sim::Vector3d v = test.body.v_WB_W();
    // What is missing falls to a tenth in 90 s: after 700 s it is 1e-8 of the speed.
    EXPECT_NEAR(v.norm(), 0.3, 1e-6);
    EXPECT_NEAR(sim::radians_to_degrees(std::atan2(-distance * v.z(), v.x())), 25, 1e-4);
    EXPECT_NEAR(test.pitch_deg(), distance * sim::radians_to_degrees(glide.pitch_rad), 1e-4);
    EXPECT_NEAR(v.y(), 0, 1e-9);
  }
}

TEST(Glider, TurnsWithItsRudderToStarboard) {
  DriftingVehicle test("glider.yaml", ", position_m: [0, 0, -500]");
  test.command("engine", -1e-4);
  test.command("battery", 0.0198);
  test.command("rudder", 0.3);
  test.run_for(200);
  EXPECT_LT(test.body.w_WB_W().z(), -0.01);
  EXPECT_LT(std::abs(sim::rpy_from_rotation(test.body.X_WB().linear()).x()), 0.5);
}

TEST(Glider, ComesUpWhenItsCommandsStop) {
  DriftingVehicle test("glider.yaml", ", position_m: [0, 0, -20], overrides: {devices.engine.watchdog_s: 10}");
  test.command("engine", -1e-4);
  test.run_for(15);
  const double deepest = test.body.X_WB().translation().z();
  EXPECT_LT(deepest, -20);
  test.run_for(400);
  EXPECT_NEAR(test.body.X_WB().translation().z(), 0, 0.3);
}

TEST(Drifter, StaysInTheSurfaceAndGoesWithTheCurrent) {
  const sim::Vector3d current(0.4, -0.3, 0);
  DriftingVehicle test("drifter.yaml", ", position_m: [0, 0, 0]", "[0.4, -0.3, 0]");
  test.run_for(600);
  EXPECT_NEAR((test.body.v_WB_W() - current).norm(), 0, 0.002);
  EXPECT_NEAR(test.body.X_WB().translation().z(), 0, 0.01);
  EXPECT_GT(test.body.X_WB().linear()(2, 2), 0.999);
}

TEST(Drifter, LosesItsVelocityThroughTheWaterByTheClosedForm) {
  DriftingVehicle test("drifter.yaml", ", position_m: [0, 0, 0], rpy_deg: [0, 0, 30]", "[0, 0, 0]", "0.001");
  const double along = sim::degrees_to_radians(30);
  const sim::Vector3d ahead(std::cos(along), std::sin(along), 0);
  test.body.set_velocity_W(0.5 * ahead, sim::Vector3d::Zero());
  test.run_for(10);
  // (m + A) v' = -2 v - 615 v^2: v = a / ((1 + b v0) exp(a t) - b v0) v0 with a = 2 / 212, b = 615 / 2.
  const double a = 2 / 212.0, b = 615 / 2.0, v0 = 0.5;
  const double v = v0 / ((1 + b * v0) * std::exp(a * 10) - b * v0);
  // It also pitches a little: its mass hangs 0.6 m below.
  EXPECT_NEAR(test.body.v_WB_W().dot(ahead), v, 0.05 * v);
}

}  // namespace
