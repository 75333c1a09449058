// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "sim/config/message_text.hpp"
#include "tools/shoal/sdf/sdf_reader.hpp"

namespace tools {

namespace {

std::optional<RobotJointType> type_of(const std::string& type) {
  if (type == "fixed") return RobotJointType::fixed;
  if (type == "revolute") return RobotJointType::revolute;
  if (type == "continuous") return RobotJointType::continuous;
  if (type == "prismatic") return RobotJointType::prismatic;
  if (type == "ball") return RobotJointType::ball;
  if (type == "universal" || type == "revolute2") return RobotJointType::universal;
  return std::nullopt;
}

/// Numbers beyond this are written for `none`: 1e16 is the default of old versions.
constexpr double no_limit = 1e6;

std::optional<double> read_limit(const XmlElement& limit, const char* name) {
  const std::optional<double> value = limit.limited_child_number(name);
  return value && std::abs(*value) < no_limit ? value : std::nullopt;
}

void read_limits(const XmlElement& axis, RobotJoint& joint) {
  const std::optional<XmlElement> limit = axis.child("limit");
  if (!limit) return;
  joint.lower = read_limit(*limit, "lower");
  joint.upper = read_limit(*limit, "upper");
  if (joint.lower && joint.upper && *joint.lower > *joint.upper)
    limit->refuse(fmt::format("<lower> must not be above <upper>, got {} and {}", sim::number_text(*joint.lower),
                              sim::number_text(*joint.upper)));
  // A negative one means none.
  joint.max_effort = read_limit(*limit, "effort");
  joint.max_velocity = read_limit(*limit, "velocity");
}

double read_sdf_loss(const XmlElement& dynamics, const char* name) {
  const double value = dynamics.child_number(name).value_or(0);
  if (value < 0) dynamics.refuse(fmt::format("<{}> must be >= 0, got {}", name, sim::number_text(value)));
  return value;
}

void read_dynamics_and_mimic(const XmlElement& axis, RobotJoint& joint, std::vector<ImportNote>& notes) {
  if (const auto dynamics = axis.child("dynamics")) {
    joint.damping = read_sdf_loss(*dynamics, "damping");
    joint.friction = read_sdf_loss(*dynamics, "friction");
    if (dynamics->child_number("spring_stiffness").value_or(0) != 0)
      notes.push_back({dynamics->place(), axis.who() + ": <spring_stiffness> is not imported: joints have no springs"});
  }
  const std::optional<XmlElement> mimic = axis.child("mimic");
  if (!mimic) return;
  const double reference = mimic->child_number("reference").value_or(0);
  joint.mimic = {mimic->text("joint"), mimic->child_number("multiplier").value_or(1),
                 mimic->child_number("offset").value_or(0)};
  joint.mimic->offset -= joint.mimic->multiplier * reference;
}

/// Reads the direction of an axis, and the frame in which it is given.
void read_sdf_axis(const XmlElement& axis, const SdfScope& scope, int version, const std::string& joint_frame,
                   sim::Vector3d& direction, std::string& frame) {
  direction = axis.child_vector("xyz", sim::Vector3d::UnitZ());
  if (direction.norm() < 1e-9) axis.refuse("the axis must not be zero");
  const std::optional<XmlElement> xyz = axis.child("xyz");
  const std::string expressed_in = xyz ? xyz->text("expressed_in", "") : "";
  frame = expressed_in.empty() ? joint_frame : scope.full(expressed_in);
  // Until SDF 1.4 an axis is in the frame of the model, from 1.7 on it names its frame.
  constexpr int in_joint_frame = 5;
  if (axis.child_flag("use_parent_model_frame", version < in_joint_frame)) frame = scope.model_frame;
}

}  // namespace

std::optional<SdfJoint> read_sdf_joint(XmlElement element, const SdfScope& scope, int version, SdfModel& model) {
  SdfJoint read;
  RobotJoint& joint = read.joint;
  joint.name = scope.full(element.text("name"));
  joint.place = element.place();
  read.frame = joint.name;
  element.set_who("joint '" + sim::shortened(sim::printable(joint.name)) + "'");
  const std::string type = element.text("type");
  const std::optional<RobotJointType> known = type_of(type);
  if (!known) {
    model.robot.notes.push_back({element.place(), fmt::format("{} of type '{}' is not imported: Shoal has none like it",
                                                              element.who(), sim::shortened(sim::printable(type)))});
    return std::nullopt;
  }
  joint.type = *known;
  joint.parent = scope.full(element.required_child("parent").content());
  joint.child = scope.full(element.required_child("child").content());
  note_rest(element, {"pose", "parent", "child", "axis", "axis2", "sensor", "physics"}, model.robot.notes);
  for (const XmlElement& sensor : element.children("sensor"))
    model.sensors.push_back({sensor, joint.child, joint.name, read_sdf_pose(sensor).X});
  if (joint.type == RobotJointType::fixed || joint.type == RobotJointType::ball) return read;
  const XmlElement axis = element.required_child("axis");
  read_sdf_axis(axis, scope, version, read.frame, read.axis, read.axis_frame);
  read_limits(axis, joint);
  read_dynamics_and_mimic(axis, joint, model.robot.notes);
  if (joint.mimic) joint.mimic->joint = scope.full(joint.mimic->joint);
  note_rest(axis, {"xyz", "limit", "dynamics", "mimic", "use_parent_model_frame", "initial_position"},
            model.robot.notes);
  if (joint.type != RobotJointType::universal) return read;
  const XmlElement axis2 = element.required_child("axis2");
  read_sdf_axis(axis2, scope, version, read.frame, read.axis2, read.axis2_frame);
  note_rest(axis2, {"xyz", "use_parent_model_frame"}, model.robot.notes);
  return read;
}

}  // namespace tools
