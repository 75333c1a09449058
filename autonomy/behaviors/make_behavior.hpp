// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "autonomy/behaviors/helm_behavior.hpp"

namespace autonomy {

// Behaviors of a marine vehicle; positions are east and north in m.  They throw std::invalid_argument with the reason.

/// Follows waypoints; repeatedly with `loop`.
std::unique_ptr<HelmBehavior> make_route(std::vector<Vector2d> waypoints_W, double speed_mps, bool loop);

/// Circles a point, counter-clockwise.
std::unique_ptr<HelmBehavior> make_circle(const Vector2d& center_W, double radius_m, double speed_mps);

/// Moves back and forth across the line between two points.
std::unique_ptr<HelmBehavior> make_zigzag(const Vector2d& from_W, const Vector2d& to_W, double amplitude_m, int legs,
                                          double speed_mps, bool loop);

/// Follows another vehicle, `ahead_m` of it along its course and `left_m` to its left.
std::unique_ptr<HelmBehavior> make_follow(const std::string& vehicle, double ahead_m, double left_m,
                                          double speed_max_mps);

}  // namespace autonomy
