// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace sim {

/// Counts the constraint rows of each island (bodies connected by joints and contacts) before a step: the cost of
/// WorldStep grows with the cube of this number.  Joints persist between steps, contacts do not.
///
/// A kinematic body connects like a free body, a fixed body does not: ODE walks from joint to joint over every ODE body
/// that it meets, whatever its mass (found by experiment: ODE enables a disabled body across a kinematic one).  All
/// bodies that stand on one kinematic platform are therefore one island.
class Islands {
 public:
  /// Adds a moving body.  Numbers can be reused after remove_bodies.
  void add_body(int body);
  /// Connects two moving bodies; `second` -1: the world.
  void add_joint(int first, int second, int rows);
  /// Removes bodies and the joints between them; no joint may connect them to a remaining body.
  void remove_bodies(std::span<const int> bodies);

  /// Clears the contacts of the last step.
  void begin_step();
  /// Adds a contact between two bodies; -1 means a fixed body.  Returns the rows of their island so far.  Several
  /// threads may add contacts of bodies that nothing connects.
  int add_contact(int first, int second, int rows);
  /// Number of constraint rows of the largest island by joints alone.
  int max_rows_of_joints() const { return joint_max_; }
  /// Number of constraint rows of the island of a moving body, with the contacts of this step.
  int rows_of(int body) { return rows_[static_cast<std::size_t>(root(parent_, body))]; }
  /// The same with the rows of joints alone.
  int joint_rows_of(int body) { return joint_rows_[static_cast<std::size_t>(root(joint_parent_, body))]; }
  /// Representative body of those that joints connect.
  int first_by_joints_of(int body) { return root(joint_parent_, body); }
  /// Whether the body existed at the start of the last step.
  bool knows(int body) const { return static_cast<std::size_t>(body) < parent_.size(); }
  /// Representative body of the island of a body, with the contacts of this step; the same for all its bodies.
  int first_of(int body) { return root(parent_, body); }

 private:
  static int root(std::vector<int>& parent, int body);
  static int join(std::vector<int>& parent, std::vector<int>& rows, int first, int second, int added);

  std::vector<int> joint_parent_, joint_rows_;  // with joints only
  std::vector<int> parent_, rows_;              // with the contacts of this step
  int joint_max_ = 0;
  bool paths_are_short_ = true;  // every body points to its root
};

}  // namespace sim
