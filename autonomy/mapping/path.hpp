// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "autonomy/filters/pose2.hpp"
#include "shoal/waypoints_command_t.hpp"

namespace autonomy {

/// Points of a path in the order in which they are driven, in the message for routes; depths and speed are NaN.
shoal::waypoints_command_t path_message(std::int64_t utime, const std::vector<Vector2d>& path_W);
/// Throws shoal::MessageError for a number that is not that of the points, and for places that are not finite or beyond
/// 1e7 m.
std::vector<Vector2d> path_of(const shoal::waypoints_command_t& message);

/// Place on a path.
struct OnPath {
  std::size_t before = 0;  ///< number of the point before it
  Vector2d p_W = Vector2d::Zero();
};
/// Returns the point of a path that is nearest to a place.  The path has a point at least.
OnPath nearest_on(const std::vector<Vector2d>& path_W, const Vector2d& p_W);
/// Returns the point of a path that is a distance along it after another one, at most the last one.
Vector2d ahead_on(const std::vector<Vector2d>& path_W, OnPath from, double ahead_m);

}  // namespace autonomy
