// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

namespace autonomy {

/// Scan of a planar lidar or of a forward sonar: beam i at first_angle_rad + i * step_rad, counter-clockwise from
/// straight ahead.
struct Scan {
  std::vector<float> ranges_m;
  double first_angle_rad = 0;
  double step_rad = 0;
};

/// Returns the smallest range of beams [first, last); infinity when there are none.
inline double nearest_m(const Scan& scan, std::size_t first, std::size_t last) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < last; ++i) nearest = std::min(nearest, static_cast<double>(scan.ranges_m[i]));
  return nearest;
}

}  // namespace autonomy
