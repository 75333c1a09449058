// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tests/devices/world_fixture.hpp"

namespace test {

/// A leg in the world without gravity: hip and knee are hinges about +y with servos `hip` and `knee`, which follow at
/// up to 50 rad/s; the knee is also known as `maker/knee`.  Steps of 2 ms.  `devices`: more devices, indented.
inline std::string leg_world(const std::string& devices, const std::string& servo_keys = "") {
  const auto servo = [&](const std::string& name, const std::string& more) {
    return "        - {name: " + name + ", type: joint_servo, joint: " + name +
           ", max_velocity: 50, max_effort: 100, kp: 500" + more + servo_keys + "}\n";
  };
  return R"(shoal: 1
physics: {step_s: 0.002, gravity_mps2: 0}
vehicles:
  - name: dog
    model:
      shoal: 1
      vehicle: leg
      bodies:
        - {name: thigh, position_m: [0, 0, 1], parts: [{shape: sphere, radius_m: 0.05, mass_kg: 0.2}]}
        - {name: shin, position_m: [0, 0, 0.8], parts: [{shape: sphere, radius_m: 0.05, mass_kg: 0.1}]}
      joints:
        - {name: hip, type: hinge, bodies: [thigh, world], anchor_m: [0, 0, 1.2], axis: [0, 1, 0]}
        - {name: knee, type: hinge, bodies: [shin, thigh], anchor_m: [0, 0, 0.9], axis: [0, 1, 0], low_stop: -1, high_stop: 1}
      devices:
)" + servo("hip", "") +
         servo("knee", ", alias: maker/knee") + devices;
}

}  // namespace test
