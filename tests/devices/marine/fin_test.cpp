// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/fin.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sim/world/world_editor.hpp"
#include "tests/devices/marine/marine_fixture.hpp"

namespace {

using devices::Fin;
using test::wet_device;
using test::WetBox;
using testing::HasSubstr;

using test::degree;
using test::rounding_N;

/// Force on a fin that is at its angle, at this velocity.
sim::Vector3d force(const std::string& keys, double angle_rad, const sim::Vector3d& v_W) {
  WetBox box(wet_device("type: fin, " + keys));
  box.command(angle_rad);
  box.set_velocity(v_W);
  return box.force_W();
}

sim::Vector3d torque(const std::string& keys, double angle_rad, const sim::Vector3d& v_W) {
  WetBox box(wet_device("type: fin, " + keys));
  box.command(angle_rad);
  box.set_velocity(v_W);
  return box.torque_W();
}

TEST(Fin, LiftsAndDragsAsAThinWing) {
  const double slope = std::numbers::pi * 3 / (1 + std::sqrt(1 + 2.25));
  const double C_L = slope * 0.1, q_A = 0.5 * 1000 * 4 * 0.02;
  const sim::Vector3d F =
      force("area_m2: 0.02, aspect_ratio: 3, drag_coefficient: 0.02, span_efficiency: 0.8", 0.1, {2, 0, 0});
  EXPECT_NEAR(F.y(), q_A * C_L, rounding_N);
  EXPECT_NEAR(F.x(), -q_A * (0.02 + C_L * C_L / (std::numbers::pi * 0.8 * 3)), rounding_N);
  EXPECT_NEAR(F.z(), 0, rounding_N);
}

TEST(Fin, IsReversedAsternInEachKindOfFlow) {
  // The flow that comes from behind pushes the fin to the other side, and drags it along.
  for (const char* flow : {"flow: body", "flow: local"}) {
    const std::string keys = std::string("area_m2: 0.02, lift_slope: 3, drag_coefficient: 0, ") + flow;
    const sim::Vector3d ahead = force(keys, 0.1, {2, 0, 0}), astern = force(keys, 0.1, {-2, 0, 0});
    EXPECT_GT(ahead.y(), 1) << flow;
    EXPECT_LT(astern.y(), -1) << flow;
    EXPECT_LT(ahead.x(), 0) << flow;
    EXPECT_GT(astern.x(), 0) << flow;
  }
  const std::string published = "model: coefficients, coefficients: {Y: 5, N: -3}";
  EXPECT_NEAR(force(published, 0.1, {2, 0, 0}).y(), 5 * 4 * 0.1, rounding_N);
  EXPECT_NEAR(force(published, 0.1, {-2, 0, 0}).y(), -5 * 4 * 0.1, rounding_N);
}

TEST(Fin, OfTheSpeedOfTheBodyHasNoJumpWhereTheFlowIsFromTheSide) {
  const std::string keys = "area_m2: 0.02, lift_slope: 3, flow: body";
  EXPECT_NEAR(force(keys, 0.1, {0, 1, 0}).y(), 0, rounding_N);
  EXPECT_NEAR(force(keys, 0.1, {0.001, 1, 0}).y(), -force(keys, 0.1, {-0.001, 1, 0}).y(), 1e-6);
}

TEST(Fin, ItsAngleToTheFlowAtItsOwnPlaceCounts) {
  const std::string keys = "area_m2: 0.02, lift_slope: 3, drag_coefficient: 0, position_m: [-1, 0, 0]";
  // Turned into the flow it does nothing: sideslip to port, and the same by the turning of the vehicle (stern to port).
  const double slip = std::atan2(0.2, 2.0);
  EXPECT_NEAR(force(keys, slip, {2, 0.2, 0}).norm(), 0, rounding_N);
  WetBox box(wet_device("type: fin, " + keys));
  box.command(slip);
  box.set_velocity({2, 0, 0}, {0, 0, -0.2});
  // It turns by 0.0001 rad in half a step, of which 120 N/rad make 0.012 N.
  EXPECT_NEAR(box.force_W().norm(), 0, 0.015);
  // At rest in water that flows it lifts as one that moves, across the flow.
  WetBox still(wet_device("type: fin, " + keys),
               "{water: {density_kgpm3: 1000, surface_m: 50}, current: {velocity_mps: [-2, 0, 0]}}");
  still.command(0.1);
  EXPECT_NEAR(still.force_W().y(), 0.5 * 1000 * 4 * 0.02 * 0.3, rounding_N);
}

TEST(Fin, StallsSmoothlyIntoAPlate) {
  const std::string keys =
      "area_m2: 0.01, lift_slope: 3, drag_coefficient: 0, stall_deg: 15, stall_width_deg: 10, "
      "limit_deg: 90, plate_coefficient: 1.2";
  const double q_A = 0.5 * 1000 * 1 * 0.01;
  const auto lift = [&](double angle) { return force(keys, angle, {1, 0, 0}).y() / q_A; };
  EXPECT_NEAR(lift(15 * degree), 3 * 15 * degree, 1e-9);
  EXPECT_LT(lift(25 * degree), lift(15 * degree));
  for (const double angle : {25 * degree, 45 * degree, 80 * degree})
    EXPECT_NEAR(lift(angle), 1.2 * std::pow(std::sin(angle), 2) * std::cos(angle), 1e-9) << angle;
  EXPECT_NEAR(force(keys, 90 * degree, {1, 0, 0}).x() / q_A, -1.2, 1e-9);
  // Nowhere a jump: the steepest slope of C_L is below 10 per rad.
  double before = lift(0);
  for (double angle = degree; angle < 90 * degree; angle += degree) {
    const double now = lift(angle);
    EXPECT_LT(std::abs(now - before), 10 * degree) << angle;
    before = now;
  }
}

TEST(Fin, NeverPushesForward) {
  // Work of the water on a fin that moves through it at any angle is not positive.
  for (double heading = -180; heading < 180; heading += 7)
    for (double angle = -60; angle <= 60; angle += 10) {
      const sim::Vector3d v(std::cos(heading * degree), std::sin(heading * degree), 0);
      EXPECT_LE(force("limit_deg: 60, flow: local", angle * degree, v).dot(v), rounding_N) << heading << " " << angle;
    }
}

TEST(Fin, ARudderAtTheSternTurnsToStarboardAndAPlaneTurnsTheNoseDown) {
  EXPECT_LT(torque("position_m: [-0.8, 0, 0]", 0.1, {1.5, 0, 0}).z(), -0.1);
  EXPECT_GT(torque("position_m: [-0.8, 0, 0], rpy_deg: [180, 0, 0]", 0.1, {1.5, 0, 0}).z(), 0.1);
  EXPECT_GT(torque("position_m: [-0.8, 0, 0], rpy_deg: [90, 0, 0]", 0.1, {1.5, 0, 0}).y(), 0.1);
  EXPECT_LT(torque("position_m: [-0.8, 0, 0], rpy_deg: [-90, 0, 0]", 0.1, {1.5, 0, 0}).y(), -0.1);
}

TEST(Fin, OfTheRemusOfMssActsAsItsEquationsSay) {
  const std::string rudder =
      "flow: body, area_m2: 0.0133, lift_slope: 0.5, density_kgpm3: 1026, limit_deg: 20, "
      "position_m: [-0.80768, 0, 0]";
  const std::string plane =
      "flow: body, area_m2: 0.0133, lift_slope: 0.7, density_kgpm3: 1026, limit_deg: 20, "
      "position_m: [-0.80768, 0, 0], rpy_deg: [90, 0, 0]";
  // u, v, w forward, right, down; equations in forward-right-down.
  const double u = 2, v = 0.3, w = 0.2, d = 0.1;
  const sim::Vector3d velocity(u, -v, -w);
  const double q_h = 0.5 * 1026 * (u * u + v * v), q_v = 0.5 * 1026 * (u * u + w * w);
  const double Y = -q_h * 0.0133 * 0.5 * d, Z = -q_v * 0.0133 * 0.7 * d;
  const sim::Vector3d F_r = force(rudder, d, velocity), F_s = force(plane, d, velocity);
  EXPECT_NEAR((F_r - sim::Vector3d(-q_h * 0.0133 * 0.5 * d * d, -Y, 0)).norm(), 0, rounding_N);
  EXPECT_NEAR((F_s - sim::Vector3d(-q_v * 0.0133 * 0.7 * d * d, 0, -Z)).norm(), 0, rounding_N);
  EXPECT_NEAR(torque(rudder, d, velocity).z(), 0.80768 * Y, rounding_N);  // N = -0.80768 Y
  EXPECT_NEAR(torque(plane, d, velocity).y(), -0.80768 * Z, rounding_N);  // M = 0.80768 Z
}

TEST(Fin, OfTheRemusOfPresteroActsAsPrinted) {
  const std::string rudder = "model: coefficients, coefficients: {frame: frd, Y: 9.64, N: -6.15}";
  const std::string plane = "model: coefficients, coefficients: {frame: frd, Z: -9.64, M: -6.15}";
  const double u = 1.5, d = 0.07;
  EXPECT_NEAR((force(rudder, d, {u, 0.1, 0}) - sim::Vector3d(0, -9.64 * u * u * d, 0)).norm(), 0, rounding_N);
  EXPECT_NEAR((torque(rudder, d, {u, 0, 0}) - sim::Vector3d(0, 0, 6.15 * u * u * d)).norm(), 0, rounding_N);
  EXPECT_NEAR((force(plane, d, {u, 0, 0}) - sim::Vector3d(0, 0, 9.64 * u * u * d)).norm(), 0, rounding_N);
  EXPECT_NEAR((torque(plane, d, {u, 0, 0}) - sim::Vector3d(0, 6.15 * u * u * d, 0)).norm(), 0, rounding_N);
}

TEST(Fin, TurnsNoFasterAndNoFartherThanItsLimits) {
  WetBox box(wet_device("type: fin, limit_deg: 20, rate_limit_degps: 40"));
  box.command(1);
  box.run_for(0.25);
  EXPECT_NEAR(box.device<Fin>().angle_rad(), 10 * degree, 1e-12);
  box.run_for(0.5);
  EXPECT_NEAR(box.device<Fin>().angle_rad(), 20 * degree, 1e-12);
}

TEST(Fin, LagsByItsTimeConstant) {
  WetBox box(wet_device("type: fin, lag_s: 0.1"));
  box.command(0.2);
  box.run_for(0.1);
  EXPECT_NEAR(box.device<Fin>().angle_rad(), 0.2 * (1 - std::exp(-1)), 1e-12);
}

TEST(Fin, GoesAmidshipsOrStaysWhenItsCommandsAreStale) {
  for (const auto& [safe, angle] : {std::pair{"stop", 0.0}, {"hold", 0.2}}) {
    WetBox box(wet_device("type: fin, watchdog_s: 0.05, safe: " + std::string(safe)));
    box.command(0.2);
    box.run_for(0.1);
    EXPECT_EQ(box.device<Fin>().angle_rad(), angle) << safe;
  }
}

TEST(Fin, ADeadServoLeavesTheFinWhereItIs) {
  WetBox box(wet_device("type: fin"));
  box.command(0.2);
  box.run_for(0.01);
  box.world.editor().set_fault("v/d", {.kind = sim::FaultKind::dead});
  box.command(-0.2);
  box.run_for(0.01);
  EXPECT_EQ(box.device<Fin>().angle_rad(), 0.2);
}

TEST(Fin, DoesNothingInAir) {
  WetBox box(wet_device("type: fin"), "{water: {surface_m: -1}}");
  box.command(0.2);
  box.set_velocity({5, 0, 0});
  EXPECT_EQ(box.force_W().norm(), 0);
}

TEST(Fin, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& keys) { return test::error_of_device("type: fin, " + keys); };
  EXPECT_THAT(error("model: coefficients"), HasSubstr("'coefficients' is missing: 'model' coefficients needs it"));
  EXPECT_THAT(error("coefficients: {Y: 1}"), HasSubstr("'coefficients' belongs to 'model' coefficients"));
  EXPECT_THAT(error("area_m2: -1"), HasSubstr("'area_m2' must be > 0"));
  EXPECT_THAT(error("limit_deg: 120"), HasSubstr("'limit_deg' must be > 0 and <= 90, got 120"));
  EXPECT_THAT(error("flow: sideways"), HasSubstr("'flow'"));
  EXPECT_EQ(error("area_m2: 1"), "");
}

/// Sideways force of a fin by coefficients, 2 N per rad and (m/s)^2, at 0.1 rad, on a hull at rest that has 30 degrees
/// of pitch and 40 degrees of yaw, in a current of 3 m/s from astern.
double force_in_current_N(const std::string& quirks) {
  std::string text = R"(
shoal: 1
physics: {step_s: 0.001, gravity_mps2: 0}
medium: {water: {surface_m: 50}, current: {velocity_mps: [2.298133329, 1.928362829, 0]}}
vehicles:
  - name: v
    rpy_deg: [0, 30, 40]
    model:
      shoal: 1
      vehicle: hull
      bodies:
        - name: hull
          hydrodynamics: {mass_kg: 10, inertia_kgm2: [1, 1, 1]QUIRKS}
          parts: [{shape: sphere, radius_m: 0.1}]
      devices: [{name: d, type: fin, model: coefficients, coefficients: {Y: 2}}]
)";
  text.replace(text.find("QUIRKS"), 6, quirks);
  test::TestWorld made(text);
  shoal::actuator_command_t message{};
  message.value = 0.1;
  made.send("v.d.cmd", message);
  const sim::Body& body = made.world.vehicles()[0]->body("hull");
  made.world.step();
  return (body.X_WB().linear().transpose() * body.v_WB_W()).y() * 10 / 1e-3;
}

TEST(Fin, TakesTheWaterAsTheHullDoesWhenItsModelTurnsTheCurrentByTheYawAlone) {
  const double along = -2 * 9 * 0.1;  // the flow comes from behind
  EXPECT_NEAR(force_in_current_N(", quirks: {current: yaw_only}"), along, 1e-6);
  EXPECT_NEAR(force_in_current_N(""), along * std::pow(std::cos(30 * degree), 2), 1e-6);
}

}  // namespace
