// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sim/geometry/mesh.hpp"

namespace tools {

/// Returns the points that lie outermost in 256 directions, spread evenly (Fibonacci lattice), and along the axes.
/// The hull has the bounding box of all points.
std::vector<sim::Vector3d> outermost_points(const std::vector<sim::Vector3d>& points);

/// Returns the convex hull as a closed mesh that faces outwards, by insertion of one point after the other: time grows
/// with the square of their number.  std::nullopt when the points lie in one plane.
std::optional<sim::Mesh> convex_hull(const std::vector<sim::Vector3d>& points);

}  // namespace tools
