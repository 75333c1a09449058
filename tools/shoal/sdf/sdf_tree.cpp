// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "sim/config/message_text.hpp"
#include "tools/shoal/sdf/sdf_reader.hpp"
#include "tools/shoal/urdf/robot_tree.hpp"

namespace tools {

namespace {

std::string shown_joint(const RobotJoint& joint) {
  return "joint '" + sim::shortened(sim::printable(joint.name)) + "'";
}

/// Directs the joints of a model away from its roots.
class SdfTree {
 public:
  explicit SdfTree(SdfModel& model) : model_(model) {
    for (std::size_t i = 0; i < model.joints.size(); ++i)
      for (const std::string& end : {model.joints[i].joint.parent, model.joints[i].joint.child})
        joints_at_[end].push_back(i);
  }

  /// Directs the joints that connect a link to others.
  void grow_from(const std::string& root) {
    if (!reached_.insert(root).second) return;
    for (std::vector<std::string> pending{root}; !pending.empty();) {
      const std::string parent = pending.back();
      pending.pop_back();
      for (const std::size_t i : joints_at_[parent]) {
        if (!used_.insert(i).second) continue;
        const RobotJoint& joint = model_.joints[i].joint;
        const std::string& child = joint.parent == parent ? joint.child : joint.parent;
        if (reached_.insert(child).second) {
          directed_[i] = joint.parent == parent;
          pending.push_back(child);
        } else {
          model_.robot.notes.push_back(
              {joint.place, shown_joint(joint) + " is not imported: it closes a loop of joints"});
        }
      }
    }
  }
  bool has_joint_at(const std::string& link) const { return joints_at_.contains(link); }
  /// Numbers of the joints of the tree, in the order of the file, and whether each leads from its parent to its child.
  const std::map<std::size_t, bool>& directed() const { return directed_; }

 private:
  SdfModel& model_;
  std::map<std::string, std::vector<std::size_t>> joints_at_;
  std::set<std::string> reached_;
  std::set<std::size_t> used_;
  std::map<std::size_t, bool> directed_;
};

sim::Pose X_VL_of(SdfModel& model, const std::string& link, const sim::SourcePlace& place) {
  return link == "world" ? sim::Pose::Identity() : model.frames.X_V(link, place);
}

/// Joint of the tree, with its frame, axes and point relative to its child.  A joint that leads from its child to its
/// parent turns the other way.
RobotJoint directed_joint(SdfModel& model, const SdfJoint& from, bool forward) {
  RobotJoint joint = from.joint;
  if (!forward) std::swap(joint.parent, joint.child);
  const sim::Pose X_VP = X_VL_of(model, joint.parent, joint.place), X_VC = X_VL_of(model, joint.child, joint.place);
  joint.X_PJ = X_VP.inverse() * X_VC;
  const auto in_child = [&](const sim::Vector3d& axis, const std::string& frame) -> sim::Vector3d {
    const sim::Vector3d axis_V = X_VL_of(model, frame, joint.place).linear() * axis.normalized();
    return (forward ? 1 : -1) * (X_VC.linear().transpose() * axis_V);
  };
  const bool has_axis = joint.type != RobotJointType::fixed && joint.type != RobotJointType::ball;
  if (has_axis) joint.axis_J = in_child(from.axis, from.axis_frame);
  if (joint.type == RobotJointType::universal) {
    joint.axis2_J = in_child(from.axis2, from.axis2_frame);
    if (!forward) std::swap(joint.axis_J, joint.axis2_J);
  }
  const bool has_anchor = joint.type != RobotJointType::fixed && joint.type != RobotJointType::prismatic;
  if (has_anchor) joint.anchor_J = X_VC.inverse() * model.frames.X_V(from.frame, joint.place).translation();
  return joint;
}

/// A link without `<inertial>` that a joint lets move, or that stands alone, has the mass of SDF's default.  One that
/// is fixed to another is a frame.
void give_default_masses(SdfModel& model) {
  std::set<std::string> fixed;
  for (const SdfJoint& joint : model.joints)
    if (joint.joint.type == RobotJointType::fixed) fixed.insert({joint.joint.parent, joint.joint.child});
  for (RobotLink& link : model.robot.links) {
    if (link.inertial) continue;
    const std::string who = "link '" + sim::shortened(sim::printable(link.name)) + "' has no <inertial>: ";
    if (fixed.contains(link.name)) {
      model.robot.notes.push_back({link.place, who + "it has no mass, where Gazebo gives it 1 kg and 1 kg m^2"});
      continue;
    }
    link.inertial =
        RobotInertial{.X_LC = sim::Pose::Identity(), .mass_kg = 1, .inertia_kgm2 = sim::Matrix3d::Identity()};
    model.robot.notes.push_back({link.place, who + "it has 1 kg and 1 kg m^2, the default of SDF"});
  }
}

}  // namespace

RobotDescription robot_of(SdfModel& model, const std::string& root, NoMass no_mass) {
  if (no_mass == NoMass::refused) give_default_masses(model);
  SdfTree tree(model);
  if (tree.has_joint_at("world")) tree.grow_from("world");
  if (!root.empty()) tree.grow_from(root);
  if (!model.canonical_link.empty()) tree.grow_from(model.canonical_link);
  for (const RobotLink& link : model.robot.links) tree.grow_from(link.name);
  RobotDescription robot = model.robot;
  for (const auto& [number, forward] : tree.directed())
    robot.joints.push_back(directed_joint(model, model.joints[number], forward));
  check_counts(robot, robot.links.front().place);
  add_world(robot);
  drop_unconnected_links(robot);
  check_tree(robot);
  const RobotLink& first = *branches_of(robot).front().link;
  robot.X_VR = X_VL_of(model, first.name, first.place);
  return robot;
}

void resolve_joints(SdfModel& model) {
  std::set<std::string> links{"world"};
  for (const RobotLink& link : model.robot.links) links.insert(link.name);
  for (SdfJoint& each : model.joints) {
    RobotJoint& joint = each.joint;
    for (std::string* end : {&joint.parent, &joint.child}) {
      const std::string link = model.frames.link_of(*end, joint.place);
      if (!links.contains(link))
        sim::throw_config_error(joint.place, shown_joint(joint),
                                "there is no link '" + sim::shortened(sim::printable(*end)) + "'");
      *end = link;
    }
    if (joint.parent == joint.child)
      sim::throw_config_error(joint.place, shown_joint(joint), "must connect two links, got twice the same");
    if (joint.type != RobotJointType::universal) continue;
    const sim::Vector3d axis = X_VL_of(model, each.axis_frame, joint.place).linear() * each.axis.normalized();
    const sim::Vector3d axis2 = X_VL_of(model, each.axis2_frame, joint.place).linear() * each.axis2.normalized();
    constexpr double tolerance = 1e-3;
    if (std::abs(axis.dot(axis2)) > tolerance)
      sim::throw_config_error(joint.place, shown_joint(joint), "its axes must be perpendicular");
  }
}

}  // namespace tools
