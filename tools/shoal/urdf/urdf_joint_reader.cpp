// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include "sim/config/message_text.hpp"
#include "tools/shoal/urdf/urdf_reader.hpp"

namespace tools {

namespace {

RobotJointType read_type(const XmlElement& element) {
  const std::string type = element.text("type");
  if (type == "fixed") return RobotJointType::fixed;
  if (type == "revolute") return RobotJointType::revolute;
  if (type == "continuous") return RobotJointType::continuous;
  if (type == "prismatic") return RobotJointType::prismatic;
  if (type == "floating") return RobotJointType::floating;
  if (type == "planar") return RobotJointType::planar;
  element.refuse("'type' must be one of: continuous, fixed, floating, planar, prismatic, revolute, got '" +
                 sim::shortened(sim::printable(type)) + "'");
}

void read_axis(const XmlElement& element, RobotJoint& joint) {
  const std::optional<XmlElement> axis = element.child("axis");
  if (axis) joint.axis_J = axis->vector("xyz", sim::Vector3d::UnitX());
  if (joint.axis_J.norm() < 1e-9) axis->refuse("the axis must not be zero");
  joint.axis_J.normalize();
}

constexpr double min_limit = 1e-9;  // of a joint_servo

/// Reads a limit that a servo can have; 0, and a note, for another one.
double read_bound(const XmlElement& limit, const char* attribute, std::vector<ImportNote>& notes) {
  const auto leave_out = [&](const std::string& what) {
    notes.push_back({limit.place(), fmt::format("{}: '{}' of <limit> must be > 0, got {}: it is taken as unknown",
                                                limit.who(), attribute, what)});
    return 0.0;
  };
  if (!limit.has(attribute)) return leave_out("none");
  const double value = limit.limited_number(attribute);
  if (value < 0 || (value > 0 && value < min_limit)) return leave_out(sim::number_text(value));
  return value;
}

void read_limit(const XmlElement& element, RobotJoint& joint, std::vector<ImportNote>& notes) {
  const std::optional<XmlElement> limit = element.child("limit");
  const bool has_range = joint.type != RobotJointType::continuous;
  if (!limit) {
    if (has_range) notes.push_back({element.place(), element.who() + " has no <limit>: it moves without bounds"});
    return;
  }
  joint.max_effort = read_bound(*limit, "effort", notes);
  joint.max_velocity = read_bound(*limit, "velocity", notes);
  if (limit->has("acceleration")) joint.max_acceleration = read_bound(*limit, "acceleration", notes);
  if (joint.max_acceleration == 0.0) joint.max_acceleration.reset();
  for (const char* other : {"deceleration", "jerk"})
    if (limit->has(other))
      notes.push_back({limit->place(), fmt::format("{}: '{}' of <limit> is not imported", element.who(), other)});
  if (!has_range) return;
  joint.lower = limit->has("lower") ? limit->limited_number("lower") : 0;
  joint.upper = limit->has("upper") ? limit->limited_number("upper") : 0;
  if (*joint.lower > *joint.upper)
    limit->refuse(fmt::format("'lower' must not be above 'upper', got {} and {}", sim::number_text(*joint.lower),
                              sim::number_text(*joint.upper)));
}

void read_soft_limits(const XmlElement& element, RobotJoint& joint, std::vector<ImportNote>& notes) {
  const std::optional<XmlElement> safety = element.child("safety_controller");
  if (!safety) return;
  joint.soft_lower = safety->optional_number("soft_lower_limit");
  joint.soft_upper = safety->optional_number("soft_upper_limit");
  if (joint.soft_lower && joint.soft_upper && *joint.soft_lower > *joint.soft_upper)
    safety->refuse(fmt::format("'soft_lower_limit' must not be above 'soft_upper_limit', got {} and {}",
                               sim::number_text(*joint.soft_lower), sim::number_text(*joint.soft_upper)));
  notes.push_back({safety->place(), element.who() + ": gains of <safety_controller> are not imported"});
}

double read_loss(const XmlElement& dynamics, const char* attribute) {
  const double value = dynamics.optional_number(attribute).value_or(0);
  if (value < 0) dynamics.refuse(fmt::format("'{}' must be >= 0, got {}", attribute, sim::number_text(value)));
  return value;
}

void read_dynamics(const XmlElement& element, RobotJoint& joint) {
  const std::optional<XmlElement> dynamics = element.child("dynamics");
  if (!dynamics) return;
  joint.damping = read_loss(*dynamics, "damping");
  joint.friction = read_loss(*dynamics, "friction");
}

void read_mimic(const XmlElement& element, RobotJoint& joint) {
  const std::optional<XmlElement> mimic = element.child("mimic");
  if (!mimic) return;
  joint.mimic = {mimic->text("joint"), mimic->optional_number("multiplier").value_or(1),
                 mimic->optional_number("offset").value_or(0)};
}

}  // namespace

RobotJoint read_urdf_joint(XmlElement element, std::vector<ImportNote>& notes) {
  RobotJoint joint;
  joint.name = element.text("name");
  joint.place = element.place();
  element.set_who("joint '" + sim::shortened(sim::printable(joint.name)) + "'");
  joint.type = read_type(element);
  joint.parent = element.required_child("parent").text("link");
  joint.child = element.required_child("child").text("link");
  joint.X_PJ = element.origin();
  // These types have no single axis.
  const bool has_axis = joint.type != RobotJointType::fixed && joint.type != RobotJointType::floating &&
                        joint.type != RobotJointType::planar;
  if (!has_axis) return joint;
  read_axis(element, joint);
  read_limit(element, joint, notes);
  read_soft_limits(element, joint, notes);
  read_dynamics(element, joint);
  read_mimic(element, joint);
  element.note_others({"origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "safety_controller"}, notes);
  return joint;
}

}  // namespace tools
