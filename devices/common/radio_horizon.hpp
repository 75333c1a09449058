// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace devices {

// The world is flat.  Radio waves bend, so that the earth has 4/3 of its radius for straight rays (ITU-R P.310).

inline constexpr double radio_earth_radius_m = 4.0 / 3 * 6.371e6;

/// Returns the distance to the horizon of radio waves from a height above the sea.
inline double radio_horizon_m(double height_m) {
  return std::sqrt(2 * radio_earth_radius_m * std::max(height_m, 0.0));
}

/// Returns the height above the sea below which the curvature hides what is at a distance.
inline double height_below_horizon_m(double distance_m, double antenna_height_m) {
  const double beyond_m = std::max(distance_m - radio_horizon_m(antenna_height_m), 0.0);
  return beyond_m * beyond_m / (2 * radio_earth_radius_m);
}

/// Returns the angle at which waves graze the sea at a distance; negative beyond the horizon.
inline double sea_grazing_rad(double distance_m, double antenna_height_m) {
  return std::asin(std::min(antenna_height_m / distance_m, 1.0)) - distance_m / (2 * radio_earth_radius_m);
}

}  // namespace devices
