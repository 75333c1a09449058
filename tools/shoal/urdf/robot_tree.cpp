// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/robot_tree.hpp"

#include <spdlog/fmt/fmt.h>

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

void check_ends(const RobotDescription& robot) {
  std::set<std::string> links;
  std::map<std::string, const RobotJoint*> joint_to;
  for (const RobotLink& link : robot.links) links.insert(link.name);
  for (const RobotJoint& joint : robot.joints) {
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

void check_counts(const RobotDescription& robot, const sim::SourcePlace& place) {
  std::size_t shapes = 0;
  for (const RobotLink& link : robot.links) shapes += link.collisions.size() + link.visuals.size();
  const auto refuse = [&](const std::string& rule) { sim::throw_config_error(place, "", rule); };
  if (robot.links.empty()) refuse("a robot needs a <link>");
  if (robot.links.size() > max_robot_links)
    refuse(fmt::format("a robot must have at most {} links, got {}", max_robot_links, robot.links.size()));
  if (shapes > max_robot_shapes)
    refuse(fmt::format("a robot must have at most {} shapes, got {}", max_robot_shapes, shapes));
}

void add_world(RobotDescription& robot) {
  const auto is_world = [](const RobotLink& link) { return link.name == "world"; };
  const auto is_at_world = [](const RobotJoint& joint) { return joint.parent == "world"; };
  const auto joint = std::find_if(robot.joints.begin(), robot.joints.end(), is_at_world);
  if (joint == robot.joints.end() || std::any_of(robot.links.begin(), robot.links.end(), is_world)) return;
  robot.links.push_back({.name = "world", .inertial = {}, .collisions = {}, .visuals = {}, .place = joint->place});
}

void drop_unconnected_links(RobotDescription& robot) {
  std::set<std::string> children;
  for (const RobotJoint& joint : robot.joints)
    if (!children.insert(joint.child).second) return;  // check_tree() refuses a link of two parents
  std::map<std::string, std::set<std::string>> trees;  // links of each root
  std::vector<const RobotLink*> roots;
  std::map<std::string, std::vector<std::string>> ends_from;
  for (const RobotJoint& joint : robot.joints) ends_from[joint.parent].push_back(joint.child);
  for (const RobotLink& link : robot.links) {
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
  const auto smaller = [&](const RobotLink* a, const RobotLink* b) {
    return trees[a->name].size() < trees[b->name].size();
  };
  const std::string kept = (*std::max_element(roots.begin(), roots.end(), smaller))->name;  // the first of equal ones
  std::set<std::string> dropped;
  for (const RobotLink* root : roots) {
    if (root->name == kept) continue;
    dropped.insert(trees[root->name].begin(), trees[root->name].end());
    robot.notes.push_back({root->place, "link " + quoted_name(root->name) + " is not connected to " +
                                            quoted_name(kept) + ": neither it nor what it carries is imported"});
  }
  const auto is_dropped = [&](const std::string& link) { return dropped.contains(link); };
  std::erase_if(robot.joints, [&](const RobotJoint& joint) { return is_dropped(joint.parent); });
  std::erase_if(robot.links, [&](const RobotLink& link) { return is_dropped(link.name); });
}

void check_tree(const RobotDescription& robot) {
  check_names(robot.links, "link");
  check_names(robot.joints, "joint");
  check_ends(robot);
  // drop_unconnected_links() has left at most one link without a parent.
  std::set<std::string> children;
  for (const RobotJoint& joint : robot.joints) children.insert(joint.child);
  const bool has_root = std::any_of(robot.links.begin(), robot.links.end(),
                                    [&](const RobotLink& link) { return !children.contains(link.name); });
  if (!has_root)
    sim::throw_config_error(robot.links.front().place, "", "each link has a parent: the joints form a loop");
  // Each link has at most one parent joint, so a link that the root does not reach is in a loop.
  const std::vector<RobotBranch> branches = branches_of(robot);
  std::set<std::string> reached;
  for (const RobotBranch& branch : branches) reached.insert(branch.link->name);
  for (const RobotLink& link : robot.links)
    if (!reached.contains(link.name))
      sim::throw_config_error(link.place, "link " + quoted_name(link.name), "is in a loop of joints");
}

std::vector<RobotBranch> branches_of(const RobotDescription& robot) {
  std::map<std::string, const RobotLink*> links;
  std::map<std::string, std::vector<const RobotJoint*>> joints_from;
  std::set<std::string> children;
  for (const RobotLink& link : robot.links) links[link.name] = &link;
  for (const RobotJoint& joint : robot.joints) {
    joints_from[joint.parent].push_back(&joint);
    children.insert(joint.child);
  }
  // Depth first, so that a limb stays together in the vehicle file.
  std::vector<RobotBranch> branches;
  std::vector<RobotBranch> pending;
  for (const RobotLink& link : robot.links)
    if (!children.contains(link.name)) pending.push_back({&link, nullptr, 0});
  while (!pending.empty()) {
    branches.push_back(pending.back());
    pending.pop_back();
    const std::size_t index = branches.size() - 1;
    const std::vector<const RobotJoint*>& from = joints_from[branches.back().link->name];
    for (auto joint = from.rbegin(); joint != from.rend(); ++joint)
      pending.push_back({links[(*joint)->child], *joint, index});
  }
  return branches;
}

}  // namespace tools
