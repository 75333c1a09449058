// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/imported_joint.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/config/message_text.hpp"

namespace tools {

namespace {

/// Sets the stops of the joint and the range of its servo.
void set_range(const UrdfJoint& from, ImportedJoint& joint, std::vector<UrdfNote>& notes) {
  if (!from.lower || !from.upper) return;
  const double low = *from.lower, high = *from.upper;
  joint.servo_low = std::clamp(from.soft_lower.value_or(low), low, high);
  joint.servo_high = std::clamp(from.soft_upper.value_or(high), low, high);
  // A run starts at zero of all joints, so a stop beyond zero would throw the joint into its range.
  const double max_stop = sim::joint_info(joint.type).max_stop;
  const auto stop_at = [&](double limit, bool excludes_zero) -> std::optional<double> {
    if (std::abs(limit) <= max_stop && !excludes_zero) return limit;
    notes.push_back(
        {from.place,
         fmt::format("joint '{}': its limit {} limits only its servo: {}", joint.name, sim::number_text(limit),
                     excludes_zero ? "zero, where a run starts, is beyond it" : "a stop is at most two turns")});
    return std::nullopt;
  };
  joint.low_stop = stop_at(low, low > 0);
  joint.high_stop = stop_at(high, high < 0);
}

}  // namespace

ImportedJoint imported_joint(const UrdfJoint& from, const std::string& name, const JointEnds& ends,
                             const sim::Matrix3d& R_VJ, std::vector<UrdfNote>& notes) {
  ImportedJoint joint;
  joint.name = name;
  joint.place = from.place;
  joint.first = ends.parent;
  joint.second = ends.child;
  joint.axis_V = R_VJ * from.axis_J;
  // Shoal counts how the second body moves on the first, and `world` can only be the second.
  if (ends.parent == "world") {
    std::swap(joint.first, joint.second);
    joint.axis_V = -joint.axis_V;
  }
  switch (from.type) {
    case UrdfJointType::fixed:
    case UrdfJointType::floating:
    case UrdfJointType::planar:
      joint.type = sim::JointType::fixed;
      return joint;
    case UrdfJointType::prismatic:
      joint.type = sim::JointType::slider;
      break;
    case UrdfJointType::revolute:
    case UrdfJointType::continuous:
      joint.type = sim::JointType::hinge;
  }
  joint.damping = from.damping;
  joint.friction = from.friction;
  joint.follows = from.mimic;
  set_range(from, joint, notes);
  if (from.max_effort.value_or(0) > 0 && from.max_velocity.value_or(0) > 0) {
    joint.max_effort = from.max_effort;
    joint.max_velocity = from.max_velocity;
    joint.max_acceleration = from.max_acceleration;
    if (from.friction >= *from.max_effort) {
      notes.push_back(
          {from.place, fmt::format("joint '{}': its friction, {}, is not imported: it is not below its "
                                   "effort, {}",
                                   name, sim::number_text(from.friction), sim::number_text(*from.max_effort))});
      joint.friction = 0;
    }
  } else if (from.mimic) {
    if (from.max_velocity.value_or(0) > 0) joint.max_velocity = from.max_velocity;
  } else {
    notes.push_back(
        {from.place, "joint '" + name + "' gets no servo: that needs a <limit> with effort and velocity above 0"});
  }
  return joint;
}

}  // namespace tools
