// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "tools/shoal/urdf/robot_description.hpp"

namespace tools {

/// A link and the joint that leads to it.
struct RobotBranch {
  const RobotLink* link = nullptr;
  const RobotJoint* joint = nullptr;  ///< null: the root
  std::size_t parent = 0;             ///< index of the parent's branch
};

/// Checks the numbers of links and shapes.  Throws sim::ConfigError.
void check_counts(const RobotDescription& robot, const sim::SourcePlace& place);

/// Adds the link `world` where a joint has this parent and there is no such link, as in files of Drake.
void add_world(RobotDescription& robot);

/// Keeps the tree of most links, and adds a note for each other root.
void drop_unconnected_links(RobotDescription& robot);

/// Checks that names are unique and that the joints connect all links to one tree.  Throws sim::ConfigError.
void check_tree(const RobotDescription& robot);

/// Links of a checked robot, each after its parent; links of one parent in the order of their joints.
std::vector<RobotBranch> branches_of(const RobotDescription& robot);

}  // namespace tools
