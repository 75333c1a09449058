// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/math.hpp"

namespace sim {

/// One contact point of the last step.
struct ContactReport {
  int parts[2] = {-1, -1};  ///< numbers in PhysicsWorld::parts(), the lower one first
  Vector3d position_W = Vector3d::Zero();
  Vector3d normal_W = Vector3d::Zero();  ///< out of parts[1], into parts[0]
  double depth_m = 0;
  Vector3d force_W_N = Vector3d::Zero();  ///< on parts[0]: normal force and friction
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive(parts, position_W, normal_W, depth_m, force_W_N);
  }
};

}  // namespace sim
