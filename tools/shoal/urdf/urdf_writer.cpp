// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_writer.hpp"

#include <spdlog/fmt/fmt.h>

#include <set>
#include <string_view>
#include <utility>

#include "sim/base/number.hpp"

namespace tools {

namespace {

std::string in_xml(const std::string& text) {
  std::string escaped;
  for (const char c : text) switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  return escaped;
}

std::string attribute(std::string_view name, const std::string& value) {
  return fmt::format(" {}=\"{}\"", name, in_xml(value));
}

std::string attribute(std::string_view name, double value) {
  return attribute(name, sim::shortest_text(value == 0 ? 0 : value));  // not -0
}

std::string attribute(std::string_view name, const sim::Vector3d& v) {
  std::string text;
  for (const double value : v) text += (text.empty() ? "" : " ") + sim::shortest_text(value == 0 ? 0 : value);
  return attribute(name, text);
}

std::string origin_line(const std::string& indent, const sim::Pose& X) {
  if (X.isApprox(sim::Pose::Identity(), 1e-15)) return "";
  return indent + "<origin" + attribute("xyz", X.translation()) + attribute("rpy", sim::rpy_from_rotation(X.linear())) +
         "/>\n";
}

std::string geometry_text(const RobotShape& shape) {
  switch (shape.shape) {
    case sim::PartShape::box:
      return "<box" + attribute("size", shape.size_m) + "/>";
    case sim::PartShape::sphere:
      return "<sphere" + attribute("radius", shape.radius_m) + "/>";
    case sim::PartShape::cylinder:
      return "<cylinder" + attribute("radius", shape.radius_m) + attribute("length", shape.length_m) + "/>";
    case sim::PartShape::capsule:
      return "<capsule" + attribute("radius", shape.radius_m) + attribute("length", shape.length_m) + "/>";
    case sim::PartShape::mesh:
      return "<mesh" + attribute("filename", shape.mesh) + attribute("scale", shape.scale) + "/>";
    case sim::PartShape::plane:
    case sim::PartShape::terrain:
      break;  // not in a RobotDescription
  }
  return "";
}

std::string shape_text(const std::string& kind, const RobotShape& shape) {
  std::string text = "    <" + kind + attribute("name", shape.name) + ">\n" + origin_line("      ", shape.X_LS) +
                     "      <geometry>" + geometry_text(shape) + "</geometry>\n";
  if (kind == "visual" && !shape.color.empty()) text += "      <material" + attribute("name", shape.color) + "/>\n";
  return text + "    </" + kind + ">\n";
}

std::string inertial_text(const RobotInertial& inertial) {
  const sim::Matrix3d& I = inertial.inertia_kgm2;
  return "    <inertial>\n" + origin_line("      ", inertial.X_LC) + "      <mass" +
         attribute("value", inertial.mass_kg) + "/>\n      <inertia" + attribute("ixx", I(0, 0)) +
         attribute("ixy", I(0, 1)) + attribute("ixz", I(0, 2)) + attribute("iyy", I(1, 1)) + attribute("iyz", I(1, 2)) +
         attribute("izz", I(2, 2)) + "/>\n    </inertial>\n";
}

std::string link_text(const RobotLink& link) {
  std::string text;
  if (link.inertial) text += inertial_text(*link.inertial);
  for (const RobotShape& shape : link.collisions) text += shape_text("collision", shape);
  for (const RobotShape& shape : link.visuals) text += shape_text("visual", shape);
  const std::string head = "  <link" + attribute("name", link.name);
  return text.empty() ? head + "/>\n" : head + ">\n" + text + "  </link>\n";
}

std::string_view word_of_type(RobotJointType type) {
  switch (type) {
    case RobotJointType::revolute:
      return "revolute";
    case RobotJointType::continuous:
      return "continuous";
    case RobotJointType::prismatic:
      return "prismatic";
    case RobotJointType::floating:
      return "floating";
    case RobotJointType::planar:
      return "planar";
    case RobotJointType::fixed:
    case RobotJointType::ball:
    case RobotJointType::universal:
      break;  // URDF has no joints of several axes
  }
  return "fixed";
}

std::string limit_line(const RobotJoint& joint) {
  std::string text = "    <limit";
  if (joint.lower) text += attribute("lower", *joint.lower);
  if (joint.upper) text += attribute("upper", *joint.upper);
  text += attribute("effort", joint.max_effort.value_or(0)) + attribute("velocity", joint.max_velocity.value_or(0));
  if (joint.max_acceleration) text += attribute("acceleration", *joint.max_acceleration);
  return text + "/>\n";
}

std::string joint_text(const RobotJoint& joint) {
  const std::string_view type = word_of_type(joint.type);
  std::string text = "  <joint" + attribute("name", joint.name) + attribute("type", std::string(type)) + ">\n" +
                     origin_line("    ", joint.X_PJ) + "    <parent" + attribute("link", joint.parent) +
                     "/>\n    <child" + attribute("link", joint.child) + "/>\n";
  if (type == "fixed") return text + "  </joint>\n";
  text += "    <axis" + attribute("xyz", joint.axis_J) + "/>\n";
  if (joint.damping > 0 || joint.friction > 0)
    text += "    <dynamics" + attribute("damping", joint.damping) + attribute("friction", joint.friction) + "/>\n";
  text += limit_line(joint);
  if (joint.soft_lower && joint.soft_upper)
    text += "    <safety_controller" + attribute("soft_lower_limit", *joint.soft_lower) +
            attribute("soft_upper_limit", *joint.soft_upper) + attribute("k_velocity", 0.0) + "/>\n";
  if (joint.mimic)
    text += "    <mimic" + attribute("joint", joint.mimic->joint) + attribute("multiplier", joint.mimic->multiplier) +
            attribute("offset", joint.mimic->offset) + "/>\n";
  return text + "  </joint>\n";
}

/// Materials of the visuals, each once: their names are their colors.
std::string material_lines(const RobotDescription& robot) {
  std::set<std::string> colors;
  for (const RobotLink& link : robot.links)
    for (const RobotShape& shape : link.visuals)
      if (!shape.color.empty()) colors.insert(shape.color);
  std::string text;
  for (const std::string& color : colors) {
    std::string rgba;
    for (std::size_t i = 1; i + 1 < color.size(); i += 2)
      rgba += sim::shortest_text(std::stoi(color.substr(i, 2), nullptr, 16) / 255.0) + " ";
    text += "  <material" + attribute("name", color) + "><color" + attribute("rgba", rgba + "1") + "/></material>\n";
  }
  return text;
}

}  // namespace

std::string urdf_text(const RobotDescription& robot) {
  std::string text = "<?xml version=\"1.0\"?>\n";
  for (const std::string& line : robot.comment) text += "<!-- " + line + " -->\n";
  text += "<robot" + attribute("name", robot.name) + ">\n" + material_lines(robot);
  for (const RobotLink& link : robot.links) text += link_text(link);
  for (const RobotJoint& joint : robot.joints) text += joint_text(joint);
  return text + "</robot>\n";
}

}  // namespace tools
