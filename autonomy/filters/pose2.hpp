// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>

namespace autonomy {

using Vector2d = Eigen::Vector2d;

/// Pose in the plane of the world: east, north, and yaw counter-clockwise from east.
struct Pose2 {
  Vector2d p_W = Vector2d::Zero();
  double yaw_rad = 0;
};

/// Forward speed and yaw rate of a differential drive.
struct Twist {
  double forward_mps = 0;
  double turn_radps = 0;
};

/// Rotates a vector counter-clockwise.
inline Vector2d turned(const Vector2d& v, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

/// Rotates a vector by 90 degrees to the left.
inline Vector2d left_of(const Vector2d& v) {
  return {-v.y(), v.x()};
}

/// Unknown value in messages and estimates.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

inline double squared(double x) {
  return x * x;
}

/// Converts a time stamp or a difference of two.
inline double seconds(std::int64_t time_us) {
  return static_cast<double>(time_us) * 1e-6;
}

}  // namespace autonomy
