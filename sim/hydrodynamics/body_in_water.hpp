// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/math.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/body.hpp"

namespace sim {

/// A body and the water around it, as a step finds them.
struct BodyInWater {
  LocalWater water;  ///< at the origin of the body
  BodyMotion motion;
  Vector3d v_B = Vector3d::Zero();  ///< of the body's origin through the water, in its own axes
  Vector3d w_B = Vector3d::Zero();  ///< its angular velocity, in its own axes
  bool known = false;  ///< false: hydrodynamics do not apply to this body, and the other members are unused
};

}  // namespace sim
