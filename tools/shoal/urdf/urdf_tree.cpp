// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_tree.hpp"

#include <map>
#include <set>
#include <string>

#include "sim/config/message_text.hpp"

namespace tools {

namespace {

std::string quoted_name(const std::string& name) {
  return "'" + sim::shortened(sim::printable(name)) + "'";
}

/// Refuses a name that an earlier entry has.
template <typename Entries>
void check_names(const Entries& entries, const std::string& kind) {
  std::set<std::string> seen;
  for (const auto& entry : entries) {
    if (entry.name.empty()) sim::throw_config_error(entry.place, "", "the name of a " + kind + " must not be empty");
    if (!seen.insert(entry.name).second)
      sim::throw_config_error(entry.place, "", "there are two " + kind + "s " + quoted_name(entry.name));
  }
}

void check_ends(const UrdfRobot& robot) {
  std::set<std::string> links;
  std::map<std::string, const UrdfJoint*> joint_to;
  for (const UrdfLink& link : robot.links) links.insert(link.name);
  for (const UrdfJoint& joint : robot.joints) {
    const std::string who = "joint " + quoted_name(joint.name);
    for (const std::string& end : {joint.parent, joint.child})
      if (!links.contains(end)) sim::throw_config_error(joint.place, who, "there is no link " + quoted_name(end));
    const auto [other, added] = joint_to.try_emplace(joint.child, &joint);
    if (!added)
      sim::throw_config_error(joint.place, who,
                              "link " + quoted_name(joint.child) + " already has the parent joint " +
                                  quoted_name(other->second->name) + ": a URDF is a tree");
  }
}

}  // namespace

void check_urdf_tree(const UrdfRobot& robot) {
  check_names(robot.links, "link");
  check_names(robot.joints, "joint");
  check_ends(robot);
  // One link without a parent.
  std::set<std::string> children;
  for (const UrdfJoint& joint : robot.joints) children.insert(joint.child);
  const UrdfLink* root = nullptr;
  for (const UrdfLink& link : robot.links) {
    if (children.contains(link.name)) continue;
    if (root != nullptr)
      sim::throw_config_error(link.place, "link " + quoted_name(link.name),
                              "is not connected to " + quoted_name(root->name) + ": a robot is one tree of links");
    root = &link;
  }
  if (root == nullptr)
    sim::throw_config_error(robot.links.front().place, "", "each link has a parent: the joints form a loop");
  // Each link has at most one parent joint, so a link that the root does not reach is in a loop.
  const std::vector<UrdfBranch> branches = branches_of(robot);
  std::set<std::string> reached;
  for (const UrdfBranch& branch : branches) reached.insert(branch.link->name);
  for (const UrdfLink& link : robot.links)
    if (!reached.contains(link.name))
      sim::throw_config_error(link.place, "link " + quoted_name(link.name), "is in a loop of joints");
}

std::vector<UrdfBranch> branches_of(const UrdfRobot& robot) {
  std::map<std::string, const UrdfLink*> links;
  std::map<std::string, std::vector<const UrdfJoint*>> joints_from;
  std::set<std::string> children;
  for (const UrdfLink& link : robot.links) links[link.name] = &link;
  for (const UrdfJoint& joint : robot.joints) {
    joints_from[joint.parent].push_back(&joint);
    children.insert(joint.child);
  }
  // Depth first, so that a limb stays together in the vehicle file.
  std::vector<UrdfBranch> branches;
  std::vector<UrdfBranch> pending;
  for (const UrdfLink& link : robot.links)
    if (!children.contains(link.name)) pending.push_back({&link, nullptr, 0});
  while (!pending.empty()) {
    branches.push_back(pending.back());
    pending.pop_back();
    const std::size_t index = branches.size() - 1;
    const std::vector<const UrdfJoint*>& from = joints_from[branches.back().link->name];
    for (auto joint = from.rbegin(); joint != from.rend(); ++joint)
      pending.push_back({links[(*joint)->child], *joint, index});
  }
  return branches;
}

}  // namespace tools
