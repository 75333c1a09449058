// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/markers.hpp"

namespace bridges::ros2 {

/// Returns the area of what a marker shows; 0 of lines.
double surface_area_m2(const Marker& marker);

/// Appends points that are spread evenly over the surface of a marker, in its frame; none of lines.
void add_surface_points(const Marker& marker, std::size_t count, std::vector<SurfacePoint>& points);

}  // namespace bridges::ros2
