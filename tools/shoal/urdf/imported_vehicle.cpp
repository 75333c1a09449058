// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/imported_vehicle.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/config/message_text.hpp"
#include "tools/shoal/urdf/body_assembly.hpp"
#include "tools/shoal/urdf/robot_tree.hpp"
#include "tools/shoal/urdf/shoal_names.hpp"

namespace tools {
namespace {

bool is_free_joint(RobotJointType type) {
  return type == RobotJointType::floating || type == RobotJointType::planar;
}

/// Walks from the root to the ends, and starts a body at each joint that is not fixed.
class VehicleAssembly {
 public:
  explicit VehicleAssembly(ImportedVehicle& vehicle) : vehicle_(vehicle) {}

  /// Adds the root, which may stand for the world.
  void add_root(const RobotLink& link, const sim::Pose& X_VR, bool is_world) {
    if (is_world) return add_place(link, {X_VR, no_body});
    start_body(link, X_VR);
    add_place(link, {X_VR, 0});
    bodies_.front().add(link, X_VR, vehicle_.notes);
  }
  /// Adds a link whose parent was added before.
  void add(const RobotLink& link, const RobotJoint& joint, std::size_t parent_number) {
    const Place parent = places_[parent_number];
    const sim::Pose X_VL = parent.X_VL * joint.X_PJ;
    const bool merges = joint.type == RobotJointType::fixed && parent.body != no_body;
    if (!merges) start_body(link, X_VL);
    add_place(link, {X_VL, merges ? parent.body : bodies_.size() - 1});
    bodies_[places_.back().body].add(link, X_VL, vehicle_.notes);
    if (merges) return;
    if (is_free_joint(joint.type)) return note_free_joint(joint, parent);
    const std::string first = parent.body == no_body ? "world" : bodies_[parent.body].name();
    add_joint(joint, {first, bodies_.back().name()}, X_VL);
  }
  void fix_base() {
    if (bodies_.empty() || (places_.front().body == no_body && !has_free_root_)) return;  // it is fixed
    bodies_.front().allow_no_mass();
    RobotJoint joint;
    joint.name = "fixed_base";
    add_joint(joint, {"world", bodies_.front().name()}, bodies_.front().X_VB());
  }
  void finish(const RobotLink& root, NoMass no_mass) {
    if (bodies_.empty()) sim::throw_config_error(root.place, "", "a robot needs a link other than 'world'");
    drop_empty_ends();
    for (ImportedJoint& joint : vehicle_.joints) find_followed(joint);
    for (BodyAssembly& body : bodies_) vehicle_.bodies.push_back(body.finish(no_mass, vehicle_.notes));
  }

 private:
  static constexpr std::size_t no_body = static_cast<std::size_t>(-1);
  struct Place {
    sim::Pose X_VL = sim::Pose::Identity();
    std::size_t body = no_body;
  };

  /// A floating or planar joint from the root leaves the vehicle free.
  void note_free_joint(const RobotJoint& joint, const Place& parent) {
    const std::string who = "joint '" + sim::shortened(sim::printable(joint.name)) + "'";
    const std::string type = joint.type == RobotJointType::floating ? "floating" : "planar";
    if (parent.body != no_body || bodies_.size() > 1)
      sim::throw_config_error(joint.place, who,
                              "a joint of type '" + type +
                                  "' can only lead from the root, a link without mass and shapes, to the one link that "
                                  "carries all others; Shoal has hinges and sliders");
    has_free_root_ = true;
    vehicle_.notes.push_back({joint.place, who + " of type '" + type + "' is not imported: the vehicle moves freely"});
  }
  /// Leaves out bodies that have neither mass nor shapes and carry nothing, such as frames of tools.
  void drop_empty_ends() {
    for (std::size_t i = bodies_.size(); i-- > 1;) {
      if (!bodies_[i].is_empty()) continue;
      const std::string& name = bodies_[i].name();
      const auto has_it = [&](const ImportedJoint& joint) { return joint.first == name || joint.second == name; };
      std::vector<ImportedJoint>& joints = vehicle_.joints;
      if (std::count_if(joints.begin(), joints.end(), has_it) != 1) continue;
      std::erase_if(vehicle_.links, [&](const auto& entry) { return entry.second.body == name; });
      vehicle_.notes.push_back(
          {bodies_[i].place(),
           "body '" + name + "' has neither mass nor shapes and carries nothing: it and its joint are not imported"});
      std::erase_if(joints, has_it);
      bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  /// Replaces the name of the joint that a joint follows by that in the vehicle file.
  void find_followed(ImportedJoint& joint) {
    if (!joint.follows) return;
    const std::string original = joint.follows->joint;
    const std::string* name = joint_names_.find(original);
    for (const ImportedJoint& other : vehicle_.joints) {
      if (name == nullptr || other.name != *name || other.type == sim::JointType::fixed || &other == &joint) continue;
      joint.follows->joint = *name;
      if (joint.max_effort.value_or(0) <= 0) joint.max_effort = other.max_effort;
      if (joint.friction > 0)
        vehicle_.notes.push_back({joint.place, "joint '" + joint.name + "': its friction, " +
                                                   sim::number_text(joint.friction) +
                                                   ", is not imported: it follows another joint"});
      joint.friction = 0;
      return;
    }
    vehicle_.notes.push_back({joint.place, "joint '" + joint.name + "' moves on its own: its <mimic> names '" +
                                               sim::shortened(sim::printable(original)) +
                                               "', and no other joint that moves has this name"});
    joint.follows.reset();
  }
  void start_body(const RobotLink& link, const sim::Pose& X_VB) {
    bodies_.emplace_back(body_names_.add(link.name, link.place, vehicle_.notes), X_VB, link.place);
  }
  void add_joint(const RobotJoint& joint, const JointEnds& ends, const sim::Pose& X_VJ) {
    const std::string name = joint_names_.add(joint.name, joint.place, vehicle_.notes);
    vehicle_.joint_names[joint.name] = name;
    vehicle_.joints.push_back(imported_joint(joint, name, ends, X_VJ, vehicle_.notes));
  }
  void add_place(const RobotLink& link, const Place& place) {
    places_.push_back(place);
    LinkPlace& in_vehicle = vehicle_.links[link.name];
    if (place.body == no_body) return;
    in_vehicle = {bodies_[place.body].name(), bodies_[place.body].X_VB().inverse() * place.X_VL};
  }

  ImportedVehicle& vehicle_;
  ShoalNames body_names_{"link", {"any", "world", "sim"}};
  ShoalNames joint_names_{"joint", {"any", "world", "sim", "joints"}};  // and the device `joints`
  std::vector<BodyAssembly> bodies_;
  std::vector<Place> places_;  ///< of the links, in the order of the branches
  bool has_free_root_ = false;
};

/// Returns whether the root stands for the world: by its name, or because a free joint leads from it.
bool is_world(const std::vector<RobotBranch>& branches) {
  const RobotLink& root = *branches.front().link;
  const bool has_mass = root.inertial && root.inertial->mass_kg > 0;
  if (has_mass || !root.collisions.empty() || !root.visuals.empty()) return false;
  if (root.name == "world" && !root.inertial) return true;
  return std::any_of(branches.begin() + 1, branches.end(),
                     [](const RobotBranch& branch) { return branch.parent == 0 && is_free_joint(branch.joint->type); });
}

}  // namespace

ImportedVehicle vehicle_of(const RobotDescription& robot, const std::string& file_name, Base base, NoMass no_mass) {
  ImportedVehicle vehicle;
  vehicle.name = plain_name(robot.name);
  vehicle.source = file_name;
  vehicle.comment = robot.comment;
  vehicle.notes = robot.notes;
  VehicleAssembly assembly(vehicle);
  const std::vector<RobotBranch> branches = branches_of(robot);
  assembly.add_root(*branches.front().link, robot.X_VR, is_world(branches));
  for (std::size_t i = 1; i < branches.size(); ++i)
    assembly.add(*branches[i].link, *branches[i].joint, branches[i].parent);
  if (base == Base::fixed) assembly.fix_base();
  assembly.finish(*branches.front().link, no_mass);
  return vehicle;
}

namespace {

/// Sets the stops of the joint and the range of its servo.
void set_range(const RobotJoint& from, ImportedJoint& joint, std::vector<ImportNote>& notes) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const double low = from.lower.value_or(-none), high = from.upper.value_or(none);
  if (from.lower) joint.servo_low = std::clamp(from.soft_lower.value_or(low), low, high);
  if (from.upper) joint.servo_high = std::clamp(from.soft_upper.value_or(high), low, high);
  // A run starts at zero of all joints, so a stop beyond zero would throw the joint into its range.
  const double max_stop = sim::joint_info(joint.type).max_stop;
  const auto stop_at = [&](std::optional<double> limit, bool excludes_zero) -> std::optional<double> {
    if (!limit || (std::abs(*limit) <= max_stop && !excludes_zero)) return limit;
    notes.push_back(
        {from.place,
         fmt::format("joint '{}': its limit {} limits only its servo: {}", joint.name, sim::number_text(*limit),
                     excludes_zero ? "zero, where a run starts, is beyond it" : "a stop is at most two turns")});
    return std::nullopt;
  };
  joint.low_stop = stop_at(from.lower, low > 0);
  joint.high_stop = stop_at(from.upper, high < 0);
}

}  // namespace

ImportedJoint imported_joint(const RobotJoint& from, const std::string& name, const JointEnds& ends,
                             const sim::Pose& X_VJ, std::vector<ImportNote>& notes) {
  ImportedJoint joint;
  joint.name = name;
  joint.place = from.place;
  joint.first = ends.parent;
  joint.second = ends.child;
  joint.axis_V = X_VJ.linear() * from.axis_J;
  if (!from.anchor_J.isZero(1e-12)) joint.anchor_V = X_VJ * from.anchor_J;
  joint.has_device = from.has_device;
  // Shoal counts how the second body moves on the first, and `world` can only be the second.
  if (ends.parent == "world") {
    std::swap(joint.first, joint.second);
    joint.axis_V = -joint.axis_V;
  }
  switch (from.type) {
    case RobotJointType::fixed:
    case RobotJointType::floating:
    case RobotJointType::planar:
      joint.type = sim::JointType::fixed;
      return joint;
    case RobotJointType::ball:
      joint.type = sim::JointType::ball;
      return joint;
    case RobotJointType::universal:
      joint.type = sim::JointType::universal;
      joint.axis2_V = X_VJ.linear() * from.axis2_J;
      if (ends.parent == "world") joint.axis2_V = std::exchange(joint.axis_V, -*joint.axis2_V);
      joint.damping = from.damping;
      return joint;
    case RobotJointType::prismatic:
      joint.type = sim::JointType::slider;
      break;
    case RobotJointType::revolute:
    case RobotJointType::continuous:
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
  } else if (!from.has_device) {
    notes.push_back(
        {from.place, "joint '" + name + "' gets no servo: that needs a <limit> with effort and velocity above 0"});
  }
  return joint;
}

}  // namespace tools
