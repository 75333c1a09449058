// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "devices/motion/joint_group.hpp"
#include "shoal/joint_frames_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace joint_group_fixture {

inline const std::string group = "        - {name: group, type: joint_group}\n";

inline shoal::joint_frames_t frames(std::vector<std::string> joints, std::vector<std::vector<double>> positions) {
  shoal::joint_frames_t message{};
  message.n_joints = static_cast<std::int32_t>(joints.size());
  message.joint_name = std::move(joints);
  message.n_frames = static_cast<std::int32_t>(positions.size());
  message.position = std::move(positions);
  return message;
}

inline const devices::JointGroup& group_of(test::LoadedTestWorld& test) {
  return dynamic_cast<const devices::JointGroup&>(*test.world.find_vehicle("dog")->find_device("group")->sensor());
}

/// Set point of a servo.
inline double set_point(test::LoadedTestWorld& test, const std::string& servo) {
  const auto* device = test.world.find_vehicle("dog")->find_device(servo)->actuator();
  return dynamic_cast<const devices::JointServo&>(*device).set_point().position;
}

}  // namespace joint_group_fixture
