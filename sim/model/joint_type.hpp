// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <numbers>

#include "sim/config/choice_words.hpp"

namespace sim {

/// Types of joints, as in ODE.  Code that depends on the type uses a switch without default, so that the compiler
/// reports every place to extend for a new type.
enum class JointType { fixed, ball, hinge, hinge2, universal, slider };

inline constexpr ChoiceWords<JointType> joint_type_words{
    {"fixed", JointType::fixed},   {"ball", JointType::ball},           {"hinge", JointType::hinge},
    {"hinge2", JointType::hinge2}, {"universal", JointType::universal}, {"slider", JointType::slider}};

/// Properties of a type of joint.
struct JointInfo {
  bool second_axis;      ///< has the key `axis2`
  bool carries_a_wheel;  ///< allows unlimited rotation of one body on the other about its last axis
  bool turns;            ///< positions of its axes are angles
  /// Greatest stop, rad or m.  Two turns are more than most joints with stops have, and less than most angles that were
  /// meant in degrees.
  double max_stop = 4 * std::numbers::pi;
};

constexpr JointInfo joint_info(JointType type) {
  switch (type) {
    case JointType::fixed:
      return {.second_axis = false, .carries_a_wheel = false, .turns = true};
    case JointType::ball:
      return {.second_axis = false, .carries_a_wheel = false, .turns = true, .max_stop = std::numbers::pi};
    case JointType::hinge:
      return {.second_axis = false, .carries_a_wheel = true, .turns = true};
    case JointType::hinge2:
      return {.second_axis = true, .carries_a_wheel = true, .turns = true};
    case JointType::universal:
      return {.second_axis = true, .carries_a_wheel = false, .turns = true};
    case JointType::slider:
      break;
  }
  return {.second_axis = false,
          .carries_a_wheel = false,
          .turns = false,
          .max_stop = std::numeric_limits<double>::infinity()};
}

}  // namespace sim
