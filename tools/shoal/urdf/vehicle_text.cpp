// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/vehicle_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sim/base/number.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"

namespace tools {
namespace {

// A part whose only category to collide with is one that no part has collides with nothing.
constexpr const char* visual_category = "visual";
constexpr const char* empty_category = "nothing";

sim::Vector3d rpy_deg_of(const sim::Pose& pose) {
  sim::Vector3d rpy_deg = sim::rpy_from_rotation(pose.linear()) * sim::radians_to_degrees(1);
  // At a pitch of 90 degrees roll and yaw have the same axis: all of the angle becomes yaw.
  if (std::abs(rpy_deg[1]) > 90 - 1e-6) {
    rpy_deg[2] = std::remainder(rpy_deg[2] - std::copysign(rpy_deg[0], rpy_deg[0] * rpy_deg[1]), 360);
    rpy_deg[0] = 0;
  }
  return rpy_deg;
}

/// Returns nine numbers row by row; three when the axes of the body are the principal ones.
std::string inertia_text(const sim::Matrix3d& inertia_kgm2) {
  const double rounding = 1e-9 * inertia_kgm2.trace();
  std::vector<double> numbers;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double value = i == j ? inertia_kgm2(i, i) : (inertia_kgm2(i, j) + inertia_kgm2(j, i)) / 2;
      numbers.push_back(std::abs(value) < rounding ? 0 : value);
    }
  std::string text;
  if (std::all_of(numbers.begin() + 1, numbers.begin() + 4, [](double value) { return value == 0; }) && numbers[5] == 0)
    numbers = {numbers[0], numbers[4], numbers[8]};
  for (const double value : numbers) text += (text.empty() ? "" : ", ") + fmt::format("{:.10g}", value);
  return "[" + text + "]";
}

std::string part_text(const ImportedPart& part) {
  const RobotShape& shape = part.shape;
  FlowMap map;
  map.add_text("name", shape.name);
  map.add_text("shape", std::string(sim::word_of(sim::part_shape_words, shape.shape)));
  if (shape.shape == sim::PartShape::box) map.add("size_m", shape.size_m);
  if (sim::has_key(shape.shape, "radius_m")) map.add("radius_m", shape.radius_m);
  if (sim::has_key(shape.shape, "length_m")) map.add("length_m", shape.length_m);
  if (shape.shape == sim::PartShape::mesh) map.add_text("mesh", shape.mesh);
  map.add_unless_zero("position_m", part.X_BP.translation());
  map.add_unless_zero("rpy_deg", rpy_deg_of(part.X_BP));
  if (part.only_visual) {
    map.add("category", visual_category);
    map.add("collides_with", fmt::format("[{}]", empty_category));
  }
  if (!shape.color.empty()) map.add("color", '"' + shape.color + '"');
  return map.lines("      - ");
}

std::string body_text(const ImportedBody& body) {
  std::string text = "  - name: " + yaml_scalar(body.name) + "\n";
  const auto add_vector = [&](const char* key, const sim::Vector3d& v) {
    if (v.cwiseAbs().maxCoeff() >= 1e-12) text += fmt::format("    {}: {}\n", key, short_list({v.x(), v.y(), v.z()}));
  };
  add_vector("position_m", body.X_VB.translation());
  add_vector("rpy_deg", rpy_deg_of(body.X_VB));
  FlowMap mass;
  if (body.water.empty()) mass.add("model", "none");
  mass.add("mass_kg", body.mass_kg);
  mass.add_unless_zero("center_of_mass_m", body.center_of_mass_m);
  mass.add("inertia_kgm2", inertia_text(body.inertia_kgm2));
  mass.add(body.water);
  text += mass.lines("    hydrodynamics: ");
  if (!body.parts.empty()) text += "    parts:\n";
  for (const ImportedPart& part : body.parts) text += part_text(part);
  return text;
}

std::string joint_text(const ImportedJoint& joint) {
  FlowMap map;
  map.add_text("name", joint.name);
  map.add_text("type", std::string(sim::word_of(sim::joint_type_words, joint.type)));
  map.add("bodies", "[" + yaml_scalar(joint.first) + ", " + yaml_scalar(joint.second) + "]");
  if (joint.anchor_V) map.add("anchor_m", *joint.anchor_V);
  const bool has_axis = joint.type != sim::JointType::fixed && joint.type != sim::JointType::ball;
  if (has_axis) map.add("axis", joint.axis_V);
  if (joint.low_stop) map.add("low_stop", *joint.low_stop);
  if (joint.high_stop) map.add("high_stop", *joint.high_stop);
  if (joint.damping > 0) map.add("damping", joint.damping);
  // Coulomb friction is a motor that holds; a device of the joint replaces it.
  if (joint.friction > 0 && !joint.has_servo() && !joint.follows) map.add("motor_max_force", joint.friction);
  if (joint.axis2_V)
    map.add("axis2", "{axis: " + short_list({joint.axis2_V->x(), joint.axis2_V->y(), joint.axis2_V->z()}) + "}");
  return map.lines("  - ");
}

std::string servo_text(const ImportedJoint& joint) {
  FlowMap map;
  map.add_text("name", joint.name);
  map.add("type", "joint_servo");
  map.add_text("joint", joint.name);
  if (joint.servo_low) map.add("low", *joint.servo_low);
  if (joint.servo_high) map.add("high", *joint.servo_high);
  map.add("max_velocity", *joint.max_velocity);
  if (joint.max_acceleration) map.add("max_acceleration", *joint.max_acceleration);
  map.add("max_effort", *joint.max_effort);
  if (joint.friction > 0) map.add("friction", joint.friction);
  map.add("safe", "hold");
  return map.lines("  - ");
}

std::string follower_text(const ImportedJoint& joint) {
  FlowMap map;
  map.add_text("name", joint.name);
  map.add("type", "joint_follower");
  map.add_text("joint", joint.name);
  map.add_text("follows", joint.follows->joint);
  if (joint.follows->multiplier != 1) map.add("multiplier", joint.follows->multiplier);
  if (joint.follows->offset != 0) map.add("offset", joint.follows->offset);
  if (joint.max_effort) map.add("max_effort", *joint.max_effort);
  if (joint.max_velocity) map.add("max_velocity", *joint.max_velocity);
  return map.lines("  - ");
}

std::string device_text(const ImportedDevice& device) {
  FlowMap map;
  map.add_text("name", device.name);
  map.add("type", device.type);
  if (!device.body.empty()) map.add_text("body", device.body);
  map.add_unless_zero("position_m", device.X_BS.translation());
  map.add_unless_zero("rpy_deg", rpy_deg_of(device.X_BS));
  map.add(device.keys);
  return map.lines("  - ");
}

/// Returns a line that YAML accepts: of one that is not UTF-8, such as Latin-1, only ASCII characters are kept.
std::string in_utf8(std::string line) {
  sim::Diagnostics diagnostics;
  sim::parse_config_text("# " + line + "\n", "", diagnostics);
  if (diagnostics.ok()) return line;
  for (char& c : line)
    if (static_cast<unsigned char>(c) >= 0x80) c = '?';
  return line;
}

std::string source_name(const ImportedVehicle& vehicle) {
  return in_utf8(sim::printable(std::filesystem::path(vehicle.source).filename().string()));
}

/// Returns the first sentence of the comment; the source when the comment does not start with a short sentence.
std::string description_of(const ImportedVehicle& vehicle) {
  std::string text;
  for (const std::string& line : vehicle.comment) text += (text.empty() ? "" : " ") + in_utf8(line);
  const std::size_t end = text.find(". ");
  const bool is_sentence = end < 200 && text[0] >= 'A' && text[0] <= 'Z';
  text = is_sentence ? text.substr(0, end + 1) : "Imported from " + source_name(vehicle) + ".";
  for (char& c : text)
    if (c == '$') c = '_';  // ${name} would be a parameter
  return text;
}

std::string head_text(const ImportedVehicle& vehicle, const std::string& schema) {
  std::string text;
  if (!schema.empty()) text += "# yaml-language-server: $schema=" + schema + "\n";
  for (const std::string& line : vehicle.comment) text += "# " + in_utf8(line) + "\n";
  text += "# Made by `shoal import " + vehicle.format + "` from " + source_name(vehicle) +
          ".  `hydrodynamics` holds mass and inertia of a body;\n# `model: none` is without forces of water.\n";
  text += "shoal: 1\nvehicle: " + yaml_scalar(vehicle.name) + "\ndescription: " + yaml_scalar(description_of(vehicle)) +
          "\n";
  const bool has_visual = std::any_of(vehicle.bodies.begin(), vehicle.bodies.end(), [](const ImportedBody& body) {
    return std::any_of(body.parts.begin(), body.parts.end(), [](const ImportedPart& part) { return part.only_visual; });
  });
  if (has_visual)
    text += fmt::format("categories: [{}, {}]  # no part is of category {}\n", visual_category, empty_category,
                        empty_category);
  return text;
}

}  // namespace

std::string vehicle_text(const ImportedVehicle& vehicle, const std::string& schema) {
  std::string text = head_text(vehicle, schema);
  text += "\nbodies:\n";
  for (const ImportedBody& body : vehicle.bodies) text += body_text(body);
  if (!vehicle.joints.empty()) text += "\njoints:\n";
  for (const ImportedJoint& joint : vehicle.joints) text += joint_text(joint);
  // Devices: a servo for each axis that the URDF drives, a player of motions for all of them, and one report of all.
  const bool moves = std::any_of(vehicle.joints.begin(), vehicle.joints.end(),
                                 [](const ImportedJoint& joint) { return joint.type != sim::JointType::fixed; });
  if (moves || !vehicle.devices.empty()) text += "\ndevices:\n";
  for (const ImportedJoint& joint : vehicle.joints)
    if (joint.has_servo()) text += servo_text(joint);
  for (const ImportedJoint& joint : vehicle.joints)
    if (joint.follows) text += follower_text(joint);
  const bool has_servo = std::any_of(vehicle.joints.begin(), vehicle.joints.end(),
                                     [](const ImportedJoint& joint) { return joint.has_servo(); });
  const bool is_taken = std::any_of(vehicle.joints.begin(), vehicle.joints.end(), [](const ImportedJoint& joint) {
    return joint.name == "group" || joint.name == "player";
  });
  if (has_servo && !is_taken)
    text += "  - {name: group, type: joint_group}\n  - {name: player, type: motion_player, group: group}\n";
  if (moves) text += "  - {name: joints, type: joint_state, rate_hz: 50}\n";
  for (const ImportedDevice& device : vehicle.devices) text += device_text(device);
  return text;
}

namespace {

constexpr std::size_t max_width = 120;

}  // namespace

std::string short_number(double value) {
  if (std::abs(value) < 1e-12) return "0";
  return sim::number_text(sim::rounded_to(value, 10));
}

std::string short_list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + short_number(value);
  return "[" + text + "]";
}

std::string yaml_scalar(const std::string& text) {
  sim::ConfigNode node;
  node.kind = sim::ConfigNode::Kind::scalar;
  node.scalar = text;
  return sim::to_flow_yaml(node);
}

void FlowMap::add_text(const std::string& key, const std::string& text) {
  add(key, yaml_scalar(text));
}

void FlowMap::add(const std::string& key, double value) {
  add(key, short_number(value));
}

void FlowMap::add(const std::string& key, const sim::Vector3d& value) {
  add(key, short_list({value.x(), value.y(), value.z()}));
}

void FlowMap::add(const YamlEntries& entries) {
  entries_.insert(entries_.end(), entries.begin(), entries.end());
}

void FlowMap::add_unless_zero(const std::string& key, const sim::Vector3d& value) {
  if (value.cwiseAbs().maxCoeff() >= 1e-12) add(key, value);
}

std::string FlowMap::text() const {
  std::string all;
  for (const auto& [key, value] : entries_) all += (all.empty() ? "" : ", ") + key + ": " + value;
  return "{" + all + "}";
}

std::string FlowMap::lines(const std::string& prefix) const {
  std::string text, line = prefix + "{";
  const std::string indent(line.size(), ' ');
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::string entry = entries_[i].first + ": " + entries_[i].second + (i + 1 < entries_.size() ? "," : "}");
    if (i > 0 && line.size() + 1 + entry.size() > max_width) {
      text += line + "\n";
      line = indent + entry;
    } else {
      line += (i > 0 ? " " : "") + entry;
    }
  }
  return text + line + "\n";
}

}  // namespace tools
