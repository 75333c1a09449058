// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/urdf_tree.hpp"

#include <algorithm>
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

void add_world(UrdfRobot& robot) {
  const auto is_world = [](const UrdfLink& link) { return link.name == "world"; };
  const auto is_at_world = [](const UrdfJoint& joint) { return joint.parent == "world"; };
  const auto joint = std::find_if(robot.joints.begin(), robot.joints.end(), is_at_world);
  if (joint == robot.joints.end() || std::any_of(robot.links.begin(), robot.links.end(), is_world)) return;
  robot.links.push_back({.name = "world", .inertial = {}, .collisions = {}, .visuals = {}, .place = joint->place});
}

void drop_unconnected_links(UrdfRobot& robot) {
  std::set<std::string> children;
  for (const UrdfJoint& joint : robot.joints)
    if (!children.insert(joint.child).second) return;  // check_urdf_tree() refuses a link of two parents
  std::map<std::string, std::set<std::string>> trees;  // links of each root
  std::vector<const UrdfLink*> roots;
  std::map<std::string, std::vector<std::string>> ends_from;
  for (const UrdfJoint& joint : robot.joints) ends_from[joint.parent].push_back(joint.child);
  for (const UrdfLink& link : robot.links) {
    if (children.contains(link.name) || trees.contains(link.name)) continue;
    roots.push_back(&link);
    std::set<std::string>& tree = trees[link.name];
    for (std::vector<std::string> pending{link.name}; !pending.empty();) {
      const std::string name = pending.back();
      pending.pop_back();
      if (!tree.insert(name).second) continue;
      pending.insert(pending.end(), ends_from[name].begin(), ends_from[name].end());
    }
  }
  if (roots.size() < 2) return;
  const auto smaller = [&](const UrdfLink* a, const UrdfLink* b) {
    return trees[a->name].size() < trees[b->name].size();
  };
  const std::string kept = (*std::max_element(roots.begin(), roots.end(), smaller))->name;  // the first of equal ones
  std::set<std::string> dropped;
  for (const UrdfLink* root : roots) {
    if (root->name == kept) continue;
    dropped.insert(trees[root->name].begin(), trees[root->name].end());
    robot.notes.push_back({root->place, "link " + quoted_name(root->name) + " is not connected to " +
                                            quoted_name(kept) + ": neither it nor what it carries is imported"});
  }
  const auto is_dropped = [&](const std::string& link) { return dropped.contains(link); };
  std::erase_if(robot.joints, [&](const UrdfJoint& joint) { return is_dropped(joint.parent); });
  std::erase_if(robot.links, [&](const UrdfLink& link) { return is_dropped(link.name); });
}

void check_urdf_tree(const UrdfRobot& robot) {
  check_names(robot.links, "link");
  check_names(robot.joints, "joint");
  check_ends(robot);
  // drop_unconnected_links() has left at most one link without a parent.
  std::set<std::string> children;
  for (const UrdfJoint& joint : robot.joints) children.insert(joint.child);
  const bool has_root = std::any_of(robot.links.begin(), robot.links.end(),
                                    [&](const UrdfLink& link) { return !children.contains(link.name); });
  if (!has_root)
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
