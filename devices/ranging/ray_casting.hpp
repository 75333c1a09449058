// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/base/math.hpp"

namespace devices {

/// Returns unit vectors that sample a cone about +x with equal solid angles, on a Fibonacci spiral from the axis
/// outwards (H. Vogel, Mathematical Biosciences 44, 1979).  A single ray is the axis.
std::vector<sim::Vector3d> cone_pattern(double half_angle_rad, int rays);

/// Returns the solid angle of the cone, sr.
double cone_solid_angle_sr(double half_angle_rad);

}  // namespace devices
