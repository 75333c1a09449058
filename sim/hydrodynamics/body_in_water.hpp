// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/math.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/body.hpp"

namespace sim {

/// Motion of a body and of the surrounding water in a step, where forces act: Body::motion_for_forces().
struct BodyInWater {
  LocalWater water;                 ///< at the origin of the body
  BodyMotion motion;                ///< half a step after its start for a body that is alone
  Vector3d v_B = Vector3d::Zero();  ///< velocity of the origin relative to the water, in body axes
  Vector3d w_B = Vector3d::Zero();  ///< angular velocity of the body, in body axes
  bool known = false;  ///< false: hydrodynamics do not apply to this body, and the other members are unused
};

}  // namespace sim
