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

  Kind kind = Kind::beams;
  double range_m = 0;
  double from_rad = 0, to_rad = 0;              ///< fan: from +x, counter-clockwise about +z
  double half_angle_rad = 0;                    ///< cone
  Vector3d axis_S = Vector3d::UnitX();          ///< cone
  double horizontal_rad = 0, vertical_rad = 0;  ///< frustum: full angles
  std::vector<Vector3d> directions_S = {};      ///< beams: unit vectors
};

}  // namespace sim
