// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace motion {

constexpr int skill_joints = 16;

/// Row of a skill: angles of all joints in degrees; those that a gait does not have are 0.
struct SkillRow {
  std::vector<int> angles_deg = std::vector<int>(skill_joints);
  // Only for a behavior.
  int speed = 8;         ///< of the fastest joint to this row, 1/4 degree a step; 0: at once
  int delay = 0;         ///< after the row, 1/20 s
  int trigger_axis = 0;  ///< 0: none
  int trigger_angle_deg = 0;
};

/// Skill of OpenCat: a posture of one row, a gait that is repeated, or a behavior.
struct SkillArray {
  std::string name;  ///< empty: none
  int period = 1;    ///< number of rows; negative: behavior
  int roll_deg = 0, pitch_deg = 0;
  int loop_first = 0, loop_last = 0, loop_count = 0;  ///< rows of a behavior that are repeated
  int first_joint = 0;                                ///< that the rows have
  std::vector<SkillRow> rows;
};

/// Reads the C array `name` of a text, its only one when the name is empty, or a list of numbers alone.  Throws
/// sim::ConfigError.
SkillArray parse_skill(std::string_view text, const std::string& file, const std::string& name);
/// Returns the C array of a skill whose angles are within 254 degrees.  Angles are even when one is above 127.
std::string skill_text(const SkillArray& skill);

}  // namespace motion
