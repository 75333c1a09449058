// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/base/free_numbers.hpp"
#include "sim/physics/physics_types.hpp"
#include "sim/physics/stepped_body.hpp"
#include "sim/physics/stepped_joint.hpp"

namespace sim {

/// Bodies, parts and joints of a vehicle or an object, by number.
struct Group {
  std::string name;
  bool in_use = false;
  std::vector<int> bodies, parts, joints;
  std::vector<SteppedBody*> moving;  ///< free and kinematic
  int shard = -1;                    ///< kept by Shards; none without moving bodies
  bool anchored = false;             ///< a joint connects it to the world
};

/// The groups of a world.  This class owns
/// - the groups, with the numbers of what belongs to them,
/// - all bodies and joints, by number,
/// - the numbers that are free.  The lowest is used next, so that the same history of additions and removals gives the
///   same numbers; a snapshot prescribes those of what it adds.
///
/// It does not know what a body does in a step: Shards, FarGroups and others look at the groups, and are notified by
/// PhysicsWorld when one changes.  Orders of a step that are to be the same in each run are those of the numbers here:
/// groups ascending, and in a group its bodies in the order of their creation.
///
/// In a step the lists are only read, so that threads may share them.  Bodies and joints must be destroyed before the
/// ODE worlds of Shards.  None of this is hashed here: World visits each body and joint.
class Groups {
 public:
  int add(const std::string& name);
  /// Throws std::out_of_range when the group does not exist.
  Group& at(int number);
  /// A group that exists.
  Group& operator[](int number) { return groups_[static_cast<std::size_t>(number)]; }
  const Group& operator[](int number) const { return groups_[static_cast<std::size_t>(number)]; }
  /// Empty when the group was removed.  Throws std::out_of_range for a number that never was one.
  const std::string& name(int number) const { return groups_.at(static_cast<std::size_t>(number)).name; }
  /// By number; those that were removed are empty.
  std::span<const Group> all() const { return groups_; }
  int count() const { return static_cast<int>(groups_.size()); }

  /// Number of the body that is added next.
  int next_body() const { return body_numbers_.next(); }
  void add_body(std::unique_ptr<SteppedBody> body);
  void add_joint(Group& owner, std::unique_ptr<SteppedJoint> joint);
  SteppedBody& body(int number) const { return static_cast<SteppedBody&>(*bodies_[static_cast<std::size_t>(number)]); }
  SteppedJoint& joint(int number) const {
    return static_cast<SteppedJoint&>(*joints_[static_cast<std::size_t>(number)]);
  }
  /// By number; null where one was removed.
  const std::vector<std::unique_ptr<Body>>& bodies() const { return bodies_; }
  const std::vector<std::unique_ptr<Joint>>& joints() const { return joints_; }
  /// Calls visit(body) for each free or kinematic body.
  template <typename Visit>
  void for_each_moving(const Visit& visit) const {
    for (const Group& group : groups_)
      for (SteppedBody* body : group.moving) visit(*body);
  }

  // A removal takes place in this order; the parts of the bodies are removed between.
  void destroy_joints(const Group& removed);
  void destroy_bodies(const Group& removed);
  void remove(int number);

  /// Sets the numbers of the next group, and of its bodies and joints.  Throws std::out_of_range when one is in use.
  void prescribe(const GroupNumbers& numbers);
  bool as_prescribed() const;

 private:
  std::vector<Group> groups_;
  std::vector<std::unique_ptr<Body>> bodies_;   // each a SteppedBody
  std::vector<std::unique_ptr<Joint>> joints_;  // each a SteppedJoint
  FreeNumbers group_numbers_, body_numbers_, joint_numbers_;
};

}  // namespace sim
