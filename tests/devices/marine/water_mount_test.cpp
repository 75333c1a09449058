// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/water_mount.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "devices/marine/fin.hpp"
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
