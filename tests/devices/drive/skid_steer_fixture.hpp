// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "sim/world/world_editor.hpp"
#include "tests/devices/world_fixture.hpp"

namespace skid_steer_fixture {

/// Four wheels at (+-0.15, +-0.2) on a plane, each with a quarter of the weight.
inline std::string skid_world(const std::string& drive) {
  std::string bodies, joints;
  for (const auto& [name, x, y] : std::vector<std::tuple<std::string, std::string, std::string>>{
           {"fl", "0.15", "0.2"}, {"rl", "-0.15", "0.2"}, {"fr", "0.15", "-0.2"}, {"rr", "-0.15", "-0.2"}}) {
    bodies += "        - {name: " + name + "_wheel, position_m: [" + x + ", " + y +
              ", 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5}]}\n";
    joints += "        - {name: " + name + ", type: hinge, bodies: [base, " + name + "_wheel], anchor_m: [" + x + ", " +
              y + ", 0.1], axis: [0, 1, 0]}\n";
  }
  return R"(
shoal: 1
physics: {step_s: 0.001}
contacts: [{between: [any, any], friction: 0.8}]
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
vehicles:
  - name: r1
    model:
      shoal: 1
      vehicle: skid
      bodies:
        - {name: base, parts: [{shape: box, size_m: [0.4, 0.3, 0.1], position_m: [0, 0, 0.12], mass_kg: 10}]}
)" + bodies +
         "      joints:\n" + joints +
         "      devices:\n        - {name: drive, type: skid_steer, left_joints: [fl, rl], right_joints: [fr, rr], "
         "wheel_radius_m: 0.1" +
         drive + "}\n";
}

// Each wheel rubs against its slip, (b w - v, a w) where the sides run at -+v: the moments about the middle balance for
// v / w = b + a^2 / b.  The effective track is twice that: 2 (0.2 + 0.15^2 / 0.2) = 0.625 m.
inline const std::string track = ", track_m: 0.625, max_speed_mps: 2, max_acceleration_mps2: 5, max_torque_Nm: 20";

inline const sim::Vehicle& rover(const test::TestWorld& test) {
  return *test.world.find_vehicle("r1");
}

}  // namespace skid_steer_fixture
