// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "shoal/joint_command_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/world_fixture.hpp"

namespace arm_rover {

inline std::string motor(const std::string& more = "") {
  return "        - {name: motor, type: joint_motor, joint: shoulder, max_velocity: 5, max_force: 50" + more + "}\n";
}

inline std::string joints(const std::string& more) {
  return "        - {name: joints, type: joint_state" + more + "}\n";
}

inline void turn(test::TestWorld& test, double velocity) {
  shoal::joint_command_t command{};
  command.velocity = velocity;
  test.send("a1.motor.cmd", command);
}

inline const sim::Joint& shoulder(const test::TestWorld& test) {
  return test.world.find_vehicle("a1")->joint("shoulder");
}

/// The motor's target before each step.
inline std::vector<double> targets(test::TestWorld& test, int steps) {
  std::vector<double> all;
  for (int i = 0; i < steps; ++i) {
    test.world.step();
    all.push_back(shoulder(test).motor_velocity());
  }
  return all;
}

}  // namespace arm_rover
