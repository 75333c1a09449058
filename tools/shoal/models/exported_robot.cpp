// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/models/exported_robot.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/standalone_world.hpp"
#include "sim/world_file/load_world.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

/// Value of a key of a device as the file has it.
std::string key_text(const sim::DeviceConfig& device, std::string_view key) {
  const sim::ConfigNode* node = device.source == nullptr ? nullptr : device.source->find(key);
  return node == nullptr ? "" : node->scalar;
}

std::optional<double> key_number(const sim::DeviceConfig& device, std::string_view key) {
  return sim::read_number(key_text(device, key));
}

/// Puts links and joints together, starting at the first body.
class RobotExport {
 public:
  RobotExport(const sim::VehicleConfig& vehicle, const std::vector<RobotInertial>& masses, const std::string& folder)
      : vehicle_(vehicle), masses_(masses), folder_(folder) {
    robot_.name = vehicle.vehicle.empty() ? "vehicle" : vehicle.vehicle;
    for (const sim::PartConfig& part : all_parts()) categories_.insert(part.category);
    for (std::size_t i = 0; i < vehicle.bodies.size(); ++i) numbers_[vehicle.bodies[i].name] = i;
  }

  RobotDescription robot() {
    const bool is_anchored = std::any_of(vehicle_.joints.begin(), vehicle_.joints.end(),
                                         [](const sim::JointConfig& joint) { return joint.bodies.back() == "world"; });
    if (is_anchored) {
      robot_.links.push_back({.name = "world", .inertial = {}, .collisions = {}, .visuals = {}, .place = {}});
      frames_["world"] = sim::Pose::Identity();
    } else {
      add_link(vehicle_.bodies.front(), sim::Pose::Identity());
    }
    // Each round adds the links that joints connect to those before.
    for (bool found = true; found;) {
      found = false;
      for (const sim::JointConfig& joint : vehicle_.joints) found |= add_joint(joint);
    }
    note_the_rest();
    return std::move(robot_);
  }

 private:
  std::vector<sim::PartConfig> all_parts() const {
    std::vector<sim::PartConfig> parts;
    for (const sim::BodyConfig& body : vehicle_.bodies) parts.insert(parts.end(), body.parts.begin(), body.parts.end());
    return parts;
  }
  void note(const sim::SourcePlace& place, const std::string& text) { robot_.notes.push_back({place, text}); }

  /// Adds a body as a link with its own frame.
  void add_link(const sim::BodyConfig& body, const sim::Pose& X_VL) {
    frames_[body.name] = X_VL;
    const sim::Pose X_LB = X_VL.inverse() * sim::make_pose(body.position_m, body.rpy_rad);
    RobotLink link{.name = body.name, .inertial = {}, .collisions = {}, .visuals = {}, .place = body.place};
    RobotInertial inertial = masses_[numbers_.at(body.name)];
    inertial.X_LC = X_LB * inertial.X_LC;
    if (inertial.mass_kg > 0) link.inertial = inertial;
    for (const sim::PartConfig& part : body.parts) {
      const std::optional<RobotShape> shape = shape_of(body, part, X_LB);
      if (!shape) continue;
      if (collides(part)) link.collisions.push_back(*shape);
      link.visuals.push_back(*shape);
    }
    if (body.has_coefficients())
      note(body.hydrodynamics->place, "body '" + body.name + "': forces of the water are not in URDF");
    robot_.links.push_back(std::move(link));
  }
  bool collides(const sim::PartConfig& part) const {
    return part.collides_with.empty() ||
           std::any_of(part.collides_with.begin(), part.collides_with.end(), [&](const std::string& category) {
             return category == "solid" || categories_.contains(category);
           });
  }
  std::optional<RobotShape> shape_of(const sim::BodyConfig& body, const sim::PartConfig& part, const sim::Pose& X_LB) {
    if (part.shape == sim::PartShape::plane || part.shape == sim::PartShape::terrain) {
      note(part.place,
           fmt::format("body '{}': a {} is not in URDF", body.name, sim::word_of(sim::part_shape_words, part.shape)));
      return std::nullopt;
    }
    RobotShape shape;
    shape.name = part.name.empty() ? body.name : part.name;
    shape.shape = part.shape;
    shape.size_m = part.size_m;
    shape.radius_m = part.radius_m;
    shape.length_m = part.length_m;
    shape.scale = sim::Vector3d::Constant(part.scale);
    shape.X_LS = X_LB * sim::make_pose(part.position_m, part.rpy_rad);
    shape.color = part.color;
    shape.place = part.place;
    if (part.shape == sim::PartShape::mesh) {
      std::error_code error;
      const fs::path file = fs::absolute(fs::path(part.directory) / part.mesh, error).lexically_normal();
      const fs::path relative =
          file.lexically_relative(fs::absolute(folder_.empty() ? "." : folder_, error).lexically_normal());
      const bool is_below = !relative.empty() && *relative.begin() != "..";
      shape.mesh = is_below ? relative.string() : "file://" + file.string();
    }
    return shape;
  }
  /// Adds a joint of which one end is known.
  bool add_joint(const sim::JointConfig& joint) {
    if (done_.contains(joint.name)) return false;
    const std::string &first = joint.bodies.front(), &second = joint.bodies.back();
    const bool has_first = frames_.contains(first), has_second = frames_.contains(second);
    if (!has_first && !has_second) return false;
    done_.insert(joint.name);
    if (has_first && has_second) {
      note(joint.place, "joint '" + joint.name + "' closes a loop: URDF is a tree");
      return false;
    }
    // The joint counts how the second body moves on the first.
    const std::string &parent = has_first ? first : second, &child = has_first ? second : first;
    const sim::BodyConfig& body = vehicle_.bodies[numbers_.at(child)];
    sim::Pose X_VL = sim::make_pose(body.position_m, body.rpy_rad);
    const bool has_point = joint.type != sim::JointType::fixed && joint.type != sim::JointType::slider;
    if (has_point) X_VL.translation() = joint.anchor_m;
    RobotJoint added = directed(joint, X_VL, has_first ? 1 : -1);
    added.parent = parent;
    added.child = child;
    added.X_PJ = frames_.at(parent).inverse() * X_VL;
    robot_.joints.push_back(std::move(added));
    add_link(body, X_VL);
    return true;
  }
  RobotJoint directed(const sim::JointConfig& joint, const sim::Pose& X_VL, double sign) {
    RobotJoint added;
    added.name = joint.name;
    added.place = joint.place;
    const sim::JointAxisConfig& axis = joint.axis1;
    switch (joint.type) {
      case sim::JointType::fixed:
        return added;
      case sim::JointType::ball:
      case sim::JointType::hinge2:
      case sim::JointType::universal:
        note(joint.place, fmt::format("joint '{}' is fixed: URDF has no joint of type {}", joint.name,
                                      sim::word_of(sim::joint_type_words, joint.type)));
        return added;
      case sim::JointType::slider:
        added.type = RobotJointType::prismatic;
        break;
      case sim::JointType::hinge:
        added.type = axis.low_stop && axis.high_stop ? RobotJointType::revolute : RobotJointType::continuous;
    }
    added.axis_J = sign * (X_VL.linear().transpose() * axis.axis.normalized());
    added.damping = axis.damping;
    added.friction = axis.motor_velocity == 0 ? axis.motor_max_force : 0;
    if (axis.low_stop && axis.high_stop) {
      added.lower = axis.low_stop;
      added.upper = axis.high_stop;
    } else if (axis.low_stop || axis.high_stop) {
      note(joint.place, "joint '" + joint.name + "': a single stop is not in URDF");
    }
    add_devices_of(joint.name, added);
    if (added.type == RobotJointType::prismatic && !added.lower) {
      constexpr double far_m = 1e9;
      added.lower = -far_m;
      added.upper = far_m;
    }
    return added;
  }
  /// A servo has the limits of the joint, a follower makes it a mimic.
  void add_devices_of(const std::string& joint, RobotJoint& added) {
    for (const sim::DeviceConfig& device : vehicle_.devices) {
      if (key_text(device, "joint") != joint) continue;
      const std::optional<double> effort = key_number(device, "max_effort"),
                                  velocity = key_number(device, "max_velocity");
      if (device.type == "joint_servo") {
        exported_.insert(device.name);
        added.max_effort = effort.value_or(10);
        added.max_velocity = velocity.value_or(1);
        added.max_acceleration = key_number(device, "max_acceleration");
        added.friction = key_number(device, "friction").value_or(added.friction);
        add_range(device, added);
      } else if (device.type == "joint_follower") {
        exported_.insert(device.name);
        added.max_effort = effort.value_or(10);
        added.max_velocity = velocity;
        added.mimic = {key_text(device, "follows"), key_number(device, "multiplier").value_or(1),
                       key_number(device, "offset").value_or(0)};
      }
    }
  }
  static void add_range(const sim::DeviceConfig& servo, RobotJoint& added) {
    const std::optional<double> low = key_number(servo, "low"), high = key_number(servo, "high");
    if (!low || !high) return;
    if (!added.lower) {
      added.lower = low;
      added.upper = high;
      if (added.type == RobotJointType::continuous) added.type = RobotJointType::revolute;
    } else if (*low != *added.lower || *high != *added.upper) {
      added.soft_lower = low;
      added.soft_upper = high;
    }
  }
  void note_the_rest() {
    for (const sim::BodyConfig& body : vehicle_.bodies)
      if (!frames_.contains(body.name))
        note(body.place, "body '" + body.name + "' is not exported: no joint connects it to the others");
    for (const sim::DeviceConfig& device : vehicle_.devices)
      if (!exported_.contains(device.name))
        note(device.place, fmt::format("device '{}' of type '{}' is not in URDF", device.name, device.type));
    for (const sim::MaterialConfig& material : vehicle_.materials)
      note(vehicle_.bodies.front().place, "material '" + material.name + "': friction and reflection are not in URDF");
  }

  const sim::VehicleConfig& vehicle_;
  const std::vector<RobotInertial>& masses_;
  std::string folder_;
  RobotDescription robot_;
  std::map<std::string, std::size_t> numbers_;
  std::map<std::string, sim::Pose> frames_;  ///< of the links, in the vehicle's frame
  std::set<std::string> done_, exported_, categories_;
};

}  // namespace

RobotDescription exported_robot(const sim::VehicleConfig& vehicle, const std::vector<RobotInertial>& masses,
                                const std::string& folder) {
  return RobotExport(vehicle, masses, folder).robot();
}

std::vector<RobotInertial> masses_of(const sim::VehicleConfig& vehicle) {
  sim::LoadedWorld loaded = sim::load_world_text("shoal: 1\n", "export.yaml");
  const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  add(loaded.config.categories, vehicle.categories);
  add(loaded.config.materials, vehicle.materials);
  add(loaded.config.contacts, vehicle.contacts);
  sim::VehicleInstance instance;
  instance.name = "exported";
  instance.config = std::make_shared<sim::VehicleConfig>(vehicle);
  loaded.config.vehicles.push_back(std::move(instance));
  const sim::StandaloneWorld world(loaded.config);
  std::vector<RobotInertial> masses;
  for (const auto& [name, body] : world.vehicles().front()->bodies()) {
    RobotInertial inertial{
        .X_LC = sim::Pose::Identity(), .mass_kg = body->mass_kg(), .inertia_kgm2 = body->inertia_C_B()};
    inertial.X_LC.translation() = body->p_BC();
    masses.push_back(inertial);
  }
  return masses;
}

}  // namespace tools
