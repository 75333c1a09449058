// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/vehicle/vehicle.hpp"

namespace python {

/// True motion of a vehicle, in the layout of the NumPy type that World.states() returns.
struct Motion {
  double position_m[3];    ///< in world axes
  double orientation[4];   ///< w x y z, from vehicle to world axes, w >= 0
  double velocity_mps[3];  ///< of the origin of the vehicle, in world axes
  double rates_radps[3];   ///< angular velocity in vehicle axes
};

Motion motion_of(const sim::Vehicle& vehicle);

}  // namespace python
