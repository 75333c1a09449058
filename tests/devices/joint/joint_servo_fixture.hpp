// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "shoal/joint_servo_command_t.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/world_fixture.hpp"

namespace joint_servo_fixture {

inline std::string servo(const std::string& more) {
  return "        - {name: servo, type: joint_servo, joint: shoulder" + more + "}\n";
}

inline void command(test::TestWorld& test, int mode, double value) {
  shoal::joint_servo_command_t message{};
  message.mode = static_cast<std::int8_t>(mode);
  (mode == 0 ? message.position : mode == 1 ? message.velocity : message.effort) = value;
  test.send("a1.servo.cmd", message);
}

inline const sim::Joint& shoulder(const test::TestWorld& test) {
  return test.world.find_vehicle("a1")->joint("shoulder");
}

}  // namespace joint_servo_fixture
