// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace sim {

/// Counts the constraint rows of each island (bodies connected by joints and contacts) before a step, for
/// WorldStep costs the cube of them.  Joints stay, contacts are new in each step.
///
/// A kinematic body connects like a free one, a fixed one does not: ODE walks from joint to joint over every ODE body
/// that it meets, whatever its mass (seen by experiment: ODE wakes a disabled body across a kinematic one).  So all
/// that stands on one kinematic platform is one island.
class Islands {
 public:
  /// Numbers may be used again after remove_bodies.
  void add_body(int body);
  /// Connects two moving bodies; `second` -1: the world.
  void add_joint(int first, int second, int rows);
  /// Removes bodies with all that joints connect to them: no joint may connect them to a remaining body.
  void remove_bodies(std::span<const int> bodies);

  /// Forgets the contacts of the last step.
  void begin_step();
  /// A contact between two bodies; either may be -1: fixed.
  void add_contact(int first, int second, int rows);
  int max_rows() const { return largest_; }
  /// Of the island that a moving body is in, with the contacts of this step.
  int rows_of(int body) { return rows_[static_cast<std::size_t>(root(parent_, body))]; }
  /// It was there when the last step began.
  bool knows(int body) const { return static_cast<std::size_t>(body) < parent_.size(); }
  /// One of the bodies of its island, the same for all of them, with the contacts of this step.
  int first_of(int body) { return root(parent_, body); }

 private:
  static int root(std::vector<int>& parent, int body);
  static int join(std::vector<int>& parent, std::vector<int>& rows, int first, int second, int added);

  std::vector<int> joint_parent_, joint_rows_;  // with joints only
  std::vector<int> parent_, rows_;              // with the contacts of this step
  int joint_max_ = 0;
  bool paths_are_short_ = true;  // every body points at its root
  int largest_ = 0;
};

}  // namespace sim
