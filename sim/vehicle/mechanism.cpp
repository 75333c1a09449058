// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/mechanism.hpp"

#include <stdexcept>

#include "sim/physics/physics_world.hpp"

namespace sim {

namespace {

template <typename Part>
Part& find_named(const std::vector<std::pair<std::string, Part*>>& all, const std::string& name) {
  for (const auto& [each, part] : all)
    if (each == name) return *part;
  throw std::out_of_range(name);
}

}  // namespace

Mechanism::Mechanism(int group, const MechanismConfig& config)
    : group_(group),
      same_frame_(config.bodies.front().position_m.isZero(0) && config.bodies.front().rpy_rad.isZero(0)),
      X_BV_(make_pose(config.bodies.front().position_m, config.bodies.front().rpy_rad).inverse()) {}

Pose Mechanism::X_WV() const {
  return base().X_WB() * X_BV_;
}

Pose Mechanism::base_pose(const Pose& X_WV) const {
  return same_frame_ ? X_WV : X_WV * X_BV_.inverse();
}

void Mechanism::place(PhysicsWorld& physics, const Pose& X_WV) const {
  const Pose X_WB = base_pose(X_WV);
  // The ends of joints that are in the world count, too.
  if (bodies_.size() > 1 || !joints_.empty()) physics.move_group(group_, X_WB * base().X_WB().inverse());
  base().set_pose(X_WB);  // without rounding
  base().set_velocity_W(Vector3d::Zero(), Vector3d::Zero());
}

Body& Mechanism::body(const std::string& name) const {
  return find_named(bodies_, name);
}

Joint& Mechanism::joint(const std::string& name) const {
  return find_named(joints_, name);
}

}  // namespace sim
