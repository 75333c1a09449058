// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "motion/record/joint_commands.hpp"
#include "motion/record/record_input.hpp"

namespace joint_commands_fixture {

inline const std::vector<std::string> names{"hip", "knee", "foot"};

inline std::optional<std::size_t> number_of(const std::string& name) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return i;
  return std::nullopt;
}

inline devices::JointControls controls() {
  devices::JointControls controls;
  controls.velocity = 2;
  controls.keys = {{"hip", "1", "q", {}}, {"knee", "2", "w", 0.5}, {"foot", "3", "e", {}}};
  controls.sticks = {{"leg", "hip", 0, 1.0}, {"leg", "knee", 1, -1.0}, {"toes", "foot", 0, 4.0}};
  return controls;
}

inline motion::JointCommands commands(std::vector<std::string> actions = {}) {
  return {controls(), names, number_of, std::move(actions)};
}

}  // namespace joint_commands_fixture
