// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "sim/base/math.hpp"

namespace sim {

/// Geodetic position on the WGS84 ellipsoid.
struct GeodeticPosition {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = 0;  ///< above the ellipsoid
};

/// Local east-north-up (ENU) coordinates about an origin, converted through earth-centered coordinates with
/// GeographicLib.
class Geodesy {
 public:
  explicit Geodesy(const GeodeticPosition& origin);
  ~Geodesy();
  GeodeticPosition to_geodetic(const Vector3d& p_W) const;
  Vector3d to_local(const GeodeticPosition& position) const;
  /// Returns the rotation from the east, north and up axes at a position to those of the origin.
  Matrix3d local_axes_W(const Vector3d& p_W) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sim
