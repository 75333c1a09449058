// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "autonomy/behaviors/scan.hpp"
#include "autonomy/filters/pose2.hpp"

/// A room of straight walls and a rover without mass, for tests of what the rover thinks.
namespace flat_room {

using autonomy::Pose2;
using autonomy::Scan;
using autonomy::turned;
using autonomy::Twist;
using autonomy::Vector2d;

struct Wall {
  Vector2d a, b;
};

inline double cross(const Vector2d& u, const Vector2d& v) {
  return u.x() * v.y() - u.y() * v.x();
}

/// Distance from `origin` along a unit vector to the nearest wall.
inline double cast(const std::vector<Wall>& walls, const Vector2d& origin, const Vector2d& direction,
                   double range_max_m) {
  double nearest = range_max_m;
  for (const Wall& wall : walls) {
    const Vector2d along = wall.b - wall.a;
    const double slope = cross(direction, along);
    if (std::abs(slope) < 1e-12) continue;
    const double range = cross(wall.a - origin, along) / slope;
    const double at = cross(wall.a - origin, direction) / slope;
    if (range > 0 && at >= 0 && at <= 1) nearest = std::min(nearest, range);
  }
  return nearest;
}

/// 180 beams over 180 degrees.
inline Scan scan(const std::vector<Wall>& walls, const Pose2& pose, double range_max_m = 20) {
  Scan scan;
  scan.first_angle_rad = -std::numbers::pi / 2;
  scan.step_rad = std::numbers::pi / 179;
  for (int i = 0; i < 180; ++i) {
    const double angle = pose.yaw_rad + scan.first_angle_rad + i * scan.step_rad;
    scan.ranges_m.push_back(static_cast<float>(cast(walls, pose.p_W, {std::cos(angle), std::sin(angle)}, range_max_m)));
  }
  return scan;
}

inline double distance_m(const Wall& wall, const Vector2d& p) {
  const Vector2d along = wall.b - wall.a;
  const double at = std::clamp((p - wall.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - wall.a - at * along).norm();
}

inline double distance_m(const std::vector<Wall>& walls, const Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls) nearest = std::min(nearest, distance_m(wall, p));
  return nearest;
}

/// Drives on for a while at constant speeds (at the mean heading: second order in the turn).
inline Pose2 driven(const Pose2& pose, const Twist& twist, double dt_s) {
  const double half_turn = 0.5 * twist.turn_radps * dt_s;
  return {pose.p_W + turned({twist.forward_mps * dt_s, 0}, pose.yaw_rad + half_turn), pose.yaw_rad + 2 * half_turn};
}

/// The four walls of a box about the origin.
inline std::vector<Wall> box(double half_x_m, double half_y_m) {
  const Vector2d p[4] = {{half_x_m, -half_y_m}, {half_x_m, half_y_m}, {-half_x_m, half_y_m}, {-half_x_m, -half_y_m}};
  return {{p[0], p[1]}, {p[1], p[2]}, {p[2], p[3]}, {p[3], p[0]}};
}

}  // namespace flat_room
