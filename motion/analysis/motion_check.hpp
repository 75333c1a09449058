// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/motion/motion.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace motion {

/// Rule that a motion breaks.
enum class MotionRule {
  unknown_joint,
  unknown_light,
  unknown_sound,
  light_range,
  late_sound,
  low,
  high,
  two_joint_low,
  two_joint_high,
  velocity,
  acceleration,
  loop_seam
};

/// Where a motion breaks a rule, and the value.  Of a stretch of frames the worst is reported.
struct MotionFinding {
  MotionRule rule = MotionRule::unknown_joint;
  std::string joint;  ///< or light, or sound
  double at_s = 0;
  int key = 0;       ///< number of the last key until then, from 1; 0: none
  double value = 0;  ///< rad or m; of velocity and acceleration per s and s^2
  double limit = 0;
  std::string text() const;
};

/// Checks a motion against the servos and groups of a vehicle, frame by frame: ranges, limits of two joints,
/// velocities, accelerations, and for a loop that its end is its start; lights and sounds too.  Joints that the motion
/// does not name are at 0, or at the limit of their range that is closest to it.
std::vector<MotionFinding> check_motion(const sim::JointMotion& motion, const sim::VehicleConfig& vehicle);

/// Returns the motion with its values within the ranges of the servos and lights, and its segments long enough for
/// their velocities.  Limits of two joints and accelerations are not mended.
sim::JointMotion mended(const sim::JointMotion& motion, const sim::VehicleConfig& vehicle);

}  // namespace motion
