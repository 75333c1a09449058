// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tests/devices/world_fixture.hpp"

namespace test {

/// An arm on a hinge in the world, level along +x: a ball of 2 kg and 0.1 m radius, 0.5 m from the hinge.  The hinge's
/// axis is +y, so that a positive angle lowers the arm.
constexpr double arm_mass_kg = 2, arm_length_m = 0.5;
constexpr double arm_inertia_kgm2 = arm_mass_kg * (arm_length_m * arm_length_m + 0.4 * 0.1 * 0.1);

inline std::string arm_world(const std::string& devices, double gravity_mps2 = 9.80665,
                             const std::string& joint_keys = "") {
  return "shoal: 1\nphysics: {step_s: 0.001, gravity_mps2: " + std::to_string(gravity_mps2) + "}" + R"(
vehicles:
  - name: a1
    model:
      shoal: 1
      vehicle: arm
      bodies:
        - name: arm
          position_m: [0, 0, 1]
          parts: [{name: ball, shape: sphere, radius_m: 0.1, position_m: [0.5, 0, 0], mass_kg: 2}]
      joints:
        - {name: shoulder, type: hinge, bodies: [arm, world], anchor_m: [0, 0, 1], axis: [0, 1, 0])" +
         joint_keys + "}\n      devices:\n" + devices;
}

}  // namespace test
