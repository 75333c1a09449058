// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/sdf/sdf_plugins.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "sim/config/message_text.hpp"
#include "tools/shoal/sdf/sdf_reader.hpp"
#include "tools/shoal/urdf/vehicle_text.hpp"

namespace tools {

namespace {

/// Plugins that only switch on what a vehicle of Shoal has anyway: its sensors and the reports of its joints.
bool is_needless(const std::string& word) {
  static const std::set<std::string> words = {"Imu",
                                              "NavSat",
                                              "Magnetometer",
                                              "AirPressure",
                                              "Sensors",
                                              "Contact",
                                              "ForceTorque",
                                              "DopplerVelocityLogSystem",
                                              "JointStatePublisher",
                                              "PosePublisher"};
  return words.contains(word);
}

std::string last_word(const XmlElement& plugin) {
  const std::string name = plugin.text("name", "");
  const std::size_t colon = name.rfind(':');
  return colon == std::string::npos ? name : name.substr(colon + 1);
}

std::string shown_plugin(const XmlElement& plugin) {
  const std::string name = plugin.text("name", plugin.text("filename", ""));
  return "plugin '" + sim::shortened(sim::printable(name)) + "'";
}

SdfJoint* find_joint(SdfModel& model, const std::string& name) {
  for (SdfJoint& joint : model.joints)
    if (joint.joint.name == name) return &joint;
  return nullptr;
}

SdfJoint* joint_of_plugin(SdfModel& model, const SdfPlugin& plugin, const char* child = "joint_name") {
  const std::string name = plugin.element.child_text(child);
  return name.empty() ? nullptr : find_joint(model, plugin.scope.full(name));
}

std::string link_of_plugin(const SdfPlugin& plugin) {
  const std::string name = plugin.element.child_text("link_name");
  return name.empty() ? "" : plugin.scope.full(name);
}

/// Axis of a joint in the vehicle's frame.
sim::Vector3d axis_V_of(SdfModel& model, const SdfJoint& joint) {
  return model.frames.X_V(joint.axis_frame, joint.joint.place).linear() * joint.axis.normalized();
}

/// Joint that turns a fin: the one that leads to its link, and that merge() may have fixed.
SdfJoint* joint_of_fin(SdfModel& model, const std::string& link) {
  for (SdfJoint& joint : model.joints) {
    const bool turns = joint.joint.type == RobotJointType::revolute ||
                       (joint.joint.type == RobotJointType::fixed && !joint.axis.isZero(0));
    if (joint.joint.child == link && turns) return &joint;
  }
  return nullptr;
}

/// Frame of a fin in its link: x forward along the chord without lift, z the axis that it turns about.
struct FinMount {
  sim::Pose X_LF = sim::Pose::Identity();
  SdfJoint* joint = nullptr;  ///< null: it does not turn
};

/// Nothing when forward and upward are not two directions.
std::optional<FinMount> mount_of_fin(SdfModel& model, const SdfPlugin& plugin) {
  const XmlElement& element = plugin.element;
  const std::string link = link_of_plugin(plugin);
  sim::Vector3d forward = element.child_vector("forward", sim::Vector3d::UnitX());
  sim::Vector3d upward = element.child_vector("upward", sim::Vector3d::UnitZ());
  if (forward.norm() < 1e-9 || upward.norm() < 1e-9 || forward.cross(upward).norm() < 1e-9) return std::nullopt;
  forward.normalize();
  const sim::Vector3d span = forward.cross(upward).normalized();
  upward = span.cross(forward);
  FinMount mount;
  sim::Vector3d axis = span;
  if (SdfJoint* joint = joint_of_fin(model, link)) {
    const sim::Vector3d turned =
        model.frames.X_V(link, element.place()).linear().transpose() * axis_V_of(model, *joint);
    constexpr double parallel = 0.99;
    if (std::abs(turned.dot(span)) > parallel) {
      mount.joint = joint;
      if (turned.dot(span) < 0) axis = -span;
    }
  }
  const double zero_lift_rad = element.child_number("a0").value_or(0);
  const sim::Vector3d chord = std::cos(zero_lift_rad) * forward + std::sin(zero_lift_rad) * upward;
  mount.X_LF.linear().col(0) = chord;
  mount.X_LF.linear().col(1) = axis.cross(chord);
  mount.X_LF.linear().col(2) = axis;
  mount.X_LF.translation() = element.child_vector("cp", sim::Vector3d::Zero());
  return mount;
}

/// Why a plugin of lift and drag does not become a fin; empty: it does.
std::string no_fin_reason(SdfModel& model, const SdfPlugin& plugin) {
  constexpr double least_density_kgpm3 = 500;  // of a liquid
  const double density = plugin.element.child_number("air_density").value_or(1.2041);
  if (density < least_density_kgpm3) return "a `fin` works in water, and its <air_density> is that of a gas";
  if (plugin.element.child_flag("radial_symmetry", false)) return "a `fin` is not round";
  if (!model.frames.has(link_of_plugin(plugin))) return "there is no such <link_name>";
  if (!mount_of_fin(model, plugin)) return "<forward> and <upward> must be two directions";
  return "";
}

void note_plugin(SdfModel& model, const SdfPlugin& plugin, const std::string& reason) {
  model.robot.notes.push_back({plugin.element.place(), shown_plugin(plugin.element) + " is not imported: " + reason});
}

/// The link behind a joint becomes part of what carries it.
void merge(SdfModel& model, SdfJoint& joint, const std::string& what) {
  if (joint.joint.type == RobotJointType::fixed) return;
  model.robot.notes.push_back({joint.joint.place, fmt::format("joint '{}' is fixed: {}",
                                                              sim::shortened(sim::printable(joint.joint.name)), what)});
  joint.joint.type = RobotJointType::fixed;
}

std::vector<SdfJoint*> joints_of_wheels(SdfModel& model, const SdfPlugin& plugin, const char* child) {
  std::vector<SdfJoint*> joints;
  for (const XmlElement& name : plugin.element.children(child))
    if (SdfJoint* joint = find_joint(model, plugin.scope.full(name.content()))) joints.push_back(joint);
  return joints;
}

void prepare_wheels(SdfModel& model, const SdfPlugin& plugin) {
  const std::vector<SdfJoint*> left = joints_of_wheels(model, plugin, "left_joint");
  const std::vector<SdfJoint*> right = joints_of_wheels(model, plugin, "right_joint");
  if (left.empty() || right.empty()) return note_plugin(model, plugin, "it needs a <left_joint> and a <right_joint>");
  for (const auto& side : {left, right})
    for (SdfJoint* joint : side) {
      joint->joint.has_device = true;
      // Shoal's axes of wheels point to the left.
      if (axis_V_of(model, *joint).y() < 0) {
        joint->axis = -joint->axis;
        std::swap(joint->joint.lower, joint->joint.upper);
        for (auto* limit : {&joint->joint.lower, &joint->joint.upper})
          if (*limit) **limit = -**limit;
      }
    }
}

std::string reason_for(const std::string& word) {
  static const std::map<std::string, std::string> reasons = {
      {"JointPositionController", "a joint with the limits `effort` and `velocity` has a servo"},
      {"JointController", "write a `joint_motor`"},
      {"OdometryPublisher", "write an `odometry` device"},
      {"LinearBatteryPlugin", "write a `battery`"},
      {"MulticopterMotorModel", "Shoal has no rotors in air"},
      {"GenericMotorModel", "write a `thruster`"},
      {"AdvancedLiftDrag", "Shoal has no wings in air"},
      {"DetachableJoint", "joints do not come off"},
      {"Buoyancy", "the water of a world has a density"},
      {"Surface", "give the body a `waterline`"},
      {"CommsEndpoint", "write an `acoustic_modem`"}};
  const auto found = reasons.find(word);
  return found == reasons.end() ? "it is a program for Gazebo" : found->second;
}

/// Adds a note on a plugin that is not imported, unless the vehicle does without it what it does.
void note_other_plugin(SdfModel& model, const SdfPlugin& plugin) {
  const std::string word = last_word(plugin.element);
  const SdfJoint* joint = word == "JointPositionController" ? joint_of_plugin(model, plugin) : nullptr;
  const bool is_fin = joint != nullptr && joint->joint.type == RobotJointType::fixed;
  if (!is_needless(word) && !is_fin) note_plugin(model, plugin, reason_for(word));
}

void prepare_plugin(SdfModel& model, const SdfPlugin& plugin, SdfPluginKind kind) {
  switch (kind) {
    case SdfPluginKind::thruster:
      if (SdfJoint* joint = joint_of_plugin(model, plugin))
        merge(model, *joint, "a `thruster` does not turn its propeller");
      else
        note_plugin(model, plugin, "there is no such <joint_name>");
      return;
    case SdfPluginKind::fin:
      if (const std::string reason = no_fin_reason(model, plugin); !reason.empty())
        note_plugin(model, plugin, reason);
      else if (const auto mount = mount_of_fin(model, plugin); mount->joint != nullptr)
        merge(model, *mount->joint, "a `fin` turns without a joint");
      return;
    case SdfPluginKind::wheels:
      return prepare_wheels(model, plugin);
    case SdfPluginKind::hydrodynamics:
    case SdfPluginKind::simple_hydrodynamics:
    case SdfPluginKind::uuv_hydrodynamics:
    case SdfPluginKind::buoyancy_engine:
      return;
  }
}

void note_value(SdfDevices& devices, const XmlElement& plugin, const char* child, const std::string& text) {
  devices.vehicle().notes.push_back(
      {plugin.child(child)->place(), fmt::format("{}: <{}> is not imported: {}", shown_plugin(plugin), child, text)});
}

/// Thrust of gz-sim's Thruster: of a force command F along the axis of the joint; of an angular velocity w
/// rho D^4 (k w + a (1 - wake) u / D) |w|, where k is thrust_coefficient, or alpha_1 with a = alpha_2.
void add_thruster(SdfModel& model, const SdfPlugin& plugin, SdfDevices& devices) {
  const XmlElement& element = plugin.element;
  SdfJoint* joint = joint_of_plugin(model, plugin);
  if (joint == nullptr) return;
  const auto number = [&](const char* name, double initial) { return element.child_number(name).value_or(initial); };
  const double density = number("fluid_density", 1000), diameter_m = number("propeller_diameter", 0.02);
  const bool by_speed = element.child_flag("use_angvel_cmd", false);
  const std::optional<double> given = element.child_number("thrust_coefficient");
  const double coefficient = given ? *given : number("alpha_1", 1);
  const double N_per_square = density * std::pow(diameter_m, 4) * coefficient;
  double high = number("max_thrust_cmd", 1000), low = number("min_thrust_cmd", -1000);
  if (!(high > 0 && low <= 0)) {
    note_value(devices, element, element.child("max_thrust_cmd") ? "max_thrust_cmd" : "min_thrust_cmd",
               "a thruster can stand still: its limits become 1000 and -1000");
    high = 1000;
    low = -1000;
  }
  FlowMap keys;
  keys.add("command", by_speed ? "radps" : "thrust_N");
  keys.add("max", std::min(high, 1e6));
  keys.add("min", std::max(low, -1e6));
  double dead_band = std::max(0.0, number("deadband", 0));
  if (by_speed) {
    keys.add("ahead", std::min(std::abs(N_per_square), 1e6));
    const double loss = -density * std::pow(diameter_m, 3) * number("alpha_2", 0) * (1 - number("wake_fraction", 0.2));
    if (!given && loss > 0) keys.add("inflow_loss", std::min(loss, 1e6));
    dead_band = N_per_square == 0 ? 0 : std::sqrt(dead_band / std::abs(N_per_square));
  }
  if (dead_band > 0) keys.add("dead_band", dead_band);
  if (diameter_m > 0) keys.add("diameter_m", std::min(diameter_m, 100.0));
  if (element.child("power_load")) note_value(devices, element, "power_load", "give the thruster `full_power_W`");
  // The force acts at the origin of the propeller; a negative coefficient turns the speed into thrust astern.
  const sim::Pose X_VL = model.frames.X_V(joint->joint.child, element.place());
  sim::Vector3d direction_L = X_VL.linear().transpose() * axis_V_of(model, *joint);
  if (by_speed && coefficient < 0) direction_L = -direction_L;
  sim::Pose X_LS = sim::Pose::Identity();
  X_LS.linear() = sim::rotation_between(sim::Vector3d::UnitX(), direction_L).toRotationMatrix();
  devices.add(element, joint->joint.name, "thruster", joint->joint.child, X_LS, keys.entries());
}

/// Lift and drag of gz-sim's LiftDrag: C_L = cla a up to the stall, C_D = cda |a|.  The fin of Shoal has induced drag,
/// which grows with the square of the angle: its aspect ratio is such that both have the same drag at the stall.
void add_fin(SdfModel& model, const SdfPlugin& plugin, SdfDevices& devices) {
  const XmlElement& element = plugin.element;
  if (!no_fin_reason(model, plugin).empty()) return;
  const auto mount = mount_of_fin(model, plugin);
  const auto number = [&](const char* name, double initial) { return element.child_number(name).value_or(initial); };
  const double slope = std::clamp(number("cla", 1), 0.0, 20.0);
  const double stall_rad = std::clamp(number("alpha_stall", std::numbers::pi / 2), 0.01, sim::degrees_to_radians(89));
  const double drag = std::abs(number("cda", 0.01));
  FlowMap keys;
  keys.add("area_m2", std::clamp(number("area", 1), 1e-6, 1000.0));
  keys.add("lift_slope", slope);
  keys.add("stall_deg", short_number(sim::radians_to_degrees(stall_rad)));
  keys.add("drag_coefficient", 0.0);
  keys.add("span_efficiency", 1.0);
  if (drag > 0 && slope > 0)
    keys.add("aspect_ratio", std::clamp(slope * slope * stall_rad / (std::numbers::pi * drag), 0.01, 100.0));
  keys.add("density_kgpm3", number("air_density", 1000));
  std::string name = link_of_plugin(plugin);
  if (mount->joint != nullptr) {
    const RobotJoint& joint = mount->joint->joint;
    name = joint.name;
    const double limit_rad = std::max(std::abs(joint.lower.value_or(0)), std::abs(joint.upper.value_or(0)));
    if (limit_rad > 0) keys.add("limit_deg", std::min(sim::radians_to_degrees(limit_rad), 90.0));
    if (joint.max_velocity.value_or(0) > 0) keys.add("rate_limit_degps", sim::radians_to_degrees(*joint.max_velocity));
  }
  for (const char* other : {"cma", "cma_stall", "cla_stall", "cda_stall", "control_joint_rad_to_cl"})
    if (element.child_number(other).value_or(0) != 0)
      note_value(devices, element, other, "a `fin` stalls into a plate across the flow, and has no moment");
  devices.add(element, name, "fin", link_of_plugin(plugin), mount->X_LF, keys.entries());
}

void add_wheels(SdfModel& model, const SdfPlugin& plugin, SdfDevices& devices) {
  const XmlElement& element = plugin.element;
  const std::vector<SdfJoint*> left = joints_of_wheels(model, plugin, "left_joint");
  const std::vector<SdfJoint*> right = joints_of_wheels(model, plugin, "right_joint");
  if (left.empty() || right.empty()) return;
  const auto names = [&](const std::vector<SdfJoint*>& side) {
    std::string text;
    for (const SdfJoint* joint : side) {
      const auto known = devices.vehicle().joint_names.find(joint->joint.name);
      if (known != devices.vehicle().joint_names.end()) text += (text.empty() ? "" : ", ") + yaml_scalar(known->second);
    }
    return text;
  };
  const bool one_each = left.size() == 1 && right.size() == 1;
  if (names(left).empty() || names(right).empty()) return;
  FlowMap keys;
  keys.add(one_each ? "left_joint" : "left_joints", one_each ? names(left) : "[" + names(left) + "]");
  keys.add(one_each ? "right_joint" : "right_joints", one_each ? names(right) : "[" + names(right) + "]");
  const auto add = [&](const char* key, std::initializer_list<const char*> children) {
    for (const char* child : children)
      if (const double value = element.child_number(child).value_or(0); value > 0) return keys.add(key, value);
  };
  add("wheel_radius_m", {"wheel_radius"});
  if (!element.child("wheel_radius") && element.child_number("wheel_diameter").value_or(0) > 0)
    keys.add("wheel_radius_m", *element.child_number("wheel_diameter") / 2);
  add("track_m", {"wheel_separation"});
  add("max_speed_mps", {"max_linear_velocity", "max_velocity"});
  add("max_turn_radps", {"max_angular_velocity"});
  add("max_acceleration_mps2", {"max_linear_acceleration", "max_acceleration", "max_wheel_acceleration"});
  const double effort_Nm = left.front()->joint.max_effort.value_or(0);
  if (effort_Nm > 0)
    keys.add("max_torque_Nm", effort_Nm);
  else
    add("max_torque_Nm", {"max_wheel_torque", "torque"});
  devices.add(element, "drive", one_each ? "differential_drive" : "skid_steer", left.front()->joint.parent,
              sim::Pose::Identity(), keys.entries());
}

/// Volumes of Shoal are counted from the neutral one.
void add_buoyancy_engine(const SdfPlugin& plugin, SdfDevices& devices) {
  const XmlElement& element = plugin.element;
  const auto number = [&](const char* name, double initial) { return element.child_number(name).value_or(initial); };
  const double neutral = number("neutral_volume", 0.0003);
  FlowMap keys;
  keys.add("max_m3", std::max(0.0, number("max_volume", 0.00099) - neutral));
  keys.add("min_m3", std::min(0.0, number("min_volume", 0.00003) - neutral));
  keys.add("rate_m3ps", std::max(1e-12, number("max_inflation_rate", 0.000003)));
  keys.add("initial_m3", number("default_volume", 0.0003) - neutral);
  devices.add(element, "buoyancy_engine", "buoyancy_engine", link_of_plugin(plugin), sim::Pose::Identity(),
              keys.entries());
}

}  // namespace

std::optional<SdfPluginKind> kind_of_plugin(const XmlElement& plugin) {
  const std::string word = last_word(plugin), library = plugin.text("filename", "");
  const auto is = [&](const char* part) { return library.find(part) != std::string::npos; };
  if (word == "SimpleHydrodynamics") return SdfPluginKind::simple_hydrodynamics;
  if (word == "Hydrodynamics" || word == "HydrodynamicsPlugin") return SdfPluginKind::hydrodynamics;
  if (is("uuv_underwater_object")) return SdfPluginKind::uuv_hydrodynamics;
  if (word == "Thruster") return SdfPluginKind::thruster;
  if (word == "LiftDrag" || is("libLiftDragPlugin")) return SdfPluginKind::fin;
  if (word == "DiffDrive" || is("diff_drive") || is("DiffDrivePlugin")) return SdfPluginKind::wheels;
  if (word == "BuoyancyEngine") return SdfPluginKind::buoyancy_engine;
  return std::nullopt;
}

std::string link_of_water(const SdfPlugin& plugin) {
  const std::optional<SdfPluginKind> kind = kind_of_plugin(plugin.element);
  if (kind == SdfPluginKind::hydrodynamics || kind == SdfPluginKind::simple_hydrodynamics)
    return link_of_plugin(plugin);
  if (kind != SdfPluginKind::uuv_hydrodynamics) return "";
  const std::optional<XmlElement> link = plugin.element.child("link");
  return link ? plugin.scope.full(link->text("name", "")) : "";
}

void prepare_joints(SdfModel& model) {
  for (const SdfPlugin& plugin : model.plugins)
    if (const auto kind = kind_of_plugin(plugin.element)) prepare_plugin(model, plugin, *kind);
  for (const SdfPlugin& plugin : model.plugins)
    if (!kind_of_plugin(plugin.element)) note_other_plugin(model, plugin);
}

void add_plugins(SdfModel& model, SdfDevices& devices) {
  for (const SdfPlugin& plugin : model.plugins) {
    const std::optional<SdfPluginKind> kind = kind_of_plugin(plugin.element);
    if (kind == SdfPluginKind::thruster) add_thruster(model, plugin, devices);
    if (kind == SdfPluginKind::fin) add_fin(model, plugin, devices);
    if (kind == SdfPluginKind::wheels) add_wheels(model, plugin, devices);
    if (kind == SdfPluginKind::buoyancy_engine) add_buoyancy_engine(plugin, devices);
  }
}

}  // namespace tools
