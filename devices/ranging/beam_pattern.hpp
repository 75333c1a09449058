// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/base/math.hpp"

namespace devices {

/// Unit vectors that cover a cone about +x with equal solid angles: a sunflower spiral, the
/// first near the axis (H. Vogel, Mathematical Biosciences 44, 1979).  One of them: the axis.
std::vector<sim::Vector3d> cone_pattern(double half_angle_rad, int rays);

/// The solid angle of such a cone, sr.
double cone_solid_angle_sr(double half_angle_rad);

}  // namespace devices
