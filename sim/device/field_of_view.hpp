// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/base/math.hpp"

namespace sim {

/// Region that a sensor observes, for viewers; in the sensor frame S.
struct FieldOfView {
  /// Form of the region.
  enum class Kind {
    fan,      ///< sector of the xy-plane
    cone,     ///< about an axis
    frustum,  ///< image of a camera that looks along +x, with z up
    beams,    ///< single directions
  };

  Kind kind = Kind::beams;                  ///< form of the region
  double range_m = 0;                       ///< largest distance from S
  double range_min_m = 0;                   ///< least distance from S
  double from_rad = 0;                      ///< fan: first angle from +x, counter-clockwise about +z
  double to_rad = 0;                        ///< fan: last angle
  double half_angle_rad = 0;                ///< cone
  Vector3d axis_S = Vector3d::UnitX();      ///< cone
  double horizontal_rad = 0;                ///< frustum: full angle across
  double vertical_rad = 0;                  ///< frustum: full angle from bottom to top
  std::vector<Vector3d> directions_S = {};  ///< beams: unit vectors
};

}  // namespace sim
