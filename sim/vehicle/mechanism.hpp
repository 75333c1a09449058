// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/model/mechanism_config.hpp"
#include "sim/physics/body.hpp"
#include "sim/physics/joint.hpp"

namespace sim {

class PhysicsWorld;

/// Bodies of a vehicle or an object in the world, and the joints between them, by name: a group of the physics.
class Mechanism {
 public:
  /// Makes a mechanism without bodies and joints, which are added in the order of `config`.
  Mechanism(int group, const MechanismConfig& config);

  int group() const { return group_; }
  /// Returns the first body, which carries the frame of the vehicle or object.
  Body& base() const { return *bodies_.front().second; }
  // Products of poses in a header would be compiled again, for seconds, in every source that includes it.
  /// Pose of the frame of the vehicle or object.
  Pose X_WV() const;
  /// Pose of the first body for a pose of the frame; equal to it, to the last bit, when both frames are the same.
  Pose base_pose(const Pose& X_WV) const;
  /// Puts all bodies somewhere, as they are to each other, at rest.
  void place(PhysicsWorld& physics, const Pose& X_WV) const;

  /// Return a body or joint by its name in the file.  Throw std::out_of_range when there is none.
  Body& body(const std::string& name) const;
  Joint& joint(const std::string& name) const;
  const std::vector<std::pair<std::string, Body*>>& bodies() const { return bodies_; }
  const std::vector<std::pair<std::string, Joint*>>& joints() const { return joints_; }

  void add_body(const std::string& name, Body& body) { bodies_.emplace_back(name, &body); }
  void add_joint(const std::string& name, Joint& joint) { joints_.emplace_back(name, &joint); }

  /// Visits bodies and joints.
  void visit_state(StateArchive& archive) const {
    for (const auto& [name, body] : bodies_) body->visit_state(archive);
    for (const auto& [name, joint] : joints_) joint->visit_state(archive);
  }

 private:
  int group_;
  bool same_frame_;
  Pose X_BV_;
  std::vector<std::pair<std::string, Body*>> bodies_;
  std::vector<std::pair<std::string, Joint*>> joints_;
};

}  // namespace sim
