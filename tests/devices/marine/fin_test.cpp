// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/fin.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "sim/world/world_editor.hpp"
#include "tests/devices/marine/fin_fixture.hpp"
#include "tests/devices/marine/marine_fixture.hpp"

namespace {

using namespace fin_fixture;

using devices::Fin;
using test::degree;
using test::rounding_N;
using test::wet_device;
using test::WetBox;
using testing::HasSubstr;

sim::Vector3d torque(const std::string& keys, double angle_rad, const sim::Vector3d& v_W) {
  WetBox box(wet_device("type: fin, " + keys));
  box.command(angle_rad);
  box.set_velocity(v_W);
  return box.torque_W();
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

}  // namespace
