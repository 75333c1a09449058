// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_joint_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include "sim/config/message_text.hpp"

namespace tools {

namespace {

UrdfJointType read_type(const UrdfElement& element) {
  const std::string type = element.text("type");
  if (type == "fixed") return UrdfJointType::fixed;
  if (type == "revolute") return UrdfJointType::revolute;
  if (type == "continuous") return UrdfJointType::continuous;
  if (type == "prismatic") return UrdfJointType::prismatic;
  if (type == "floating" || type == "planar")
    element.refuse("a joint of type '" + type + "' cannot be imported; Shoal has hinges and sliders");
  element.refuse("'type' must be one of: continuous, fixed, prismatic, revolute, got '" +
                 sim::shortened(sim::printable(type)) + "'");
}

void read_axis(const UrdfElement& element, UrdfJoint& joint) {
  const std::optional<UrdfElement> axis = element.child("axis");
  if (axis) joint.axis_J = axis->vector("xyz", sim::Vector3d::UnitX());
  if (joint.axis_J.norm() < 1e-9) axis->refuse("the axis must not be zero");
  joint.axis_J.normalize();
}

constexpr double min_limit = 1e-9;  // of a joint_servo

/// Reads a limit: 0, or one that a servo can have.
double read_bound(const UrdfElement& limit, const char* attribute) {
  const double value = limit.number(attribute);
  if (value < 0) limit.refuse(fmt::format("'{}' must be >= 0, got {}", attribute, sim::number_text(value)));
  if (value > 0 && value < min_limit)
    limit.refuse(fmt::format("'{}' must be 0 or >= {}, got {}", attribute, sim::number_text(min_limit),
                             sim::number_text(value)));
  return value;
}

void read_limit(const UrdfElement& element, UrdfJoint& joint, std::vector<UrdfNote>& notes) {
  const std::optional<UrdfElement> limit = element.child("limit");
  const bool has_range = joint.type != UrdfJointType::continuous;
  if (!limit) {
    if (has_range) element.refuse("a joint of type '" + element.text("type") + "' needs a <limit>");
    return;
  }
  joint.max_effort = read_bound(*limit, "effort");
  joint.max_velocity = read_bound(*limit, "velocity");
  if (limit->has("acceleration")) joint.max_acceleration = read_bound(*limit, "acceleration");
  if (joint.max_acceleration == 0.0) limit->refuse("'acceleration' must be > 0, got 0");
  for (const char* other : {"deceleration", "jerk"})
    if (limit->has(other))
      notes.push_back({limit->place(), fmt::format("{}: '{}' of <limit> is not imported", element.who(), other)});
  if (!has_range) return;
  joint.lower = limit->optional_number("lower").value_or(0);
  joint.upper = limit->optional_number("upper").value_or(0);
  if (*joint.lower > *joint.upper)
    limit->refuse(fmt::format("'lower' must not be above 'upper', got {} and {}", sim::number_text(*joint.lower),
                              sim::number_text(*joint.upper)));
}

void read_soft_limits(const UrdfElement& element, UrdfJoint& joint, std::vector<UrdfNote>& notes) {
  const std::optional<UrdfElement> safety = element.child("safety_controller");
  if (!safety) return;
  joint.soft_lower = safety->optional_number("soft_lower_limit");
  joint.soft_upper = safety->optional_number("soft_upper_limit");
  if (joint.soft_lower && joint.soft_upper && *joint.soft_lower > *joint.soft_upper)
    safety->refuse(fmt::format("'soft_lower_limit' must not be above 'soft_upper_limit', got {} and {}",
                               sim::number_text(*joint.soft_lower), sim::number_text(*joint.soft_upper)));
  notes.push_back({safety->place(), element.who() + ": gains of <safety_controller> are not imported"});
}

/// Adds notes for elements that Shoal does not hold.
void note_losses(const UrdfElement& element, std::vector<UrdfNote>& notes) {
  if (const auto mimic = element.child("mimic"))
    notes.push_back(
        {mimic->place(), fmt::format("{}: <mimic> of joint '{}' is not imported: the joint moves on its own",
                                     element.who(), mimic->text("joint", ""))});
  if (const auto dynamics = element.child("dynamics"))
    for (const char* key : {"damping", "friction"})
      if (dynamics->optional_number(key).value_or(0) != 0)
        notes.push_back(
            {dynamics->place(), fmt::format("{}: {} {} is not imported", element.who(), key, dynamics->text(key))});
  element.note_others({"origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "safety_controller"}, notes);
}

}  // namespace

UrdfJoint read_urdf_joint(UrdfElement element, std::vector<UrdfNote>& notes) {
  UrdfJoint joint;
  joint.name = element.text("name");
  joint.place = element.place();
  element.set_who("joint '" + sim::shortened(sim::printable(joint.name)) + "'");
  joint.type = read_type(element);
  joint.parent = element.required_child("parent").text("link");
  joint.child = element.required_child("child").text("link");
  joint.X_PJ = element.origin();
  if (joint.type == UrdfJointType::fixed) return joint;
  read_axis(element, joint);
  read_limit(element, joint, notes);
  read_soft_limits(element, joint, notes);
  note_losses(element, notes);
  return joint;
}

}  // namespace tools
