// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "autonomy/filters/odometer.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"

namespace autonomy {

/// Scan in the frame of the vehicle.
struct Beams {
  Vector2d sensor_B = Vector2d::Zero();
  std::vector<Vector2d> ends_B;
  std::vector<char> hits;          ///< whether a beam met something
  std::vector<Vector2d> points_B;  ///< the ends of those that did
};

/// How a lidar is mounted and used.
struct LidarMount {
  Pose2 pose;               ///< of the lidar on the vehicle
  double range_m = 20;      ///< a beam of at least this length is taken as a miss
  double use_range_m = 15;  ///< longer beams only clear this length
};

Beams beams_of(const shoal::planar_lidar_t& scan, const LidarMount& lidar);
/// Returns the ends of the beams for a pose of the vehicle.
std::vector<Vector2d> ends_W_of(const Beams& beams, const Pose2& pose);

/// Returns a point of the vehicle in the frame of its pose.
Vector2d placed(const Pose2& pose, const Vector2d& p_B);
Pose2 moved(const Pose2& pose, const Increment& by);

/// Throws shoal::MessageError for numbers that no vehicle reaches.
void check_reachable(const shoal::odometry_t& odometry);
/// Returns the move since the last call until `utime`, at most 1 s from the report: by the speed of the report.
Increment moved_until(std::int64_t utime, const shoal::odometry_t& odometry, Odometer& odometer);

/// `covariance_m2`: of east and north.  What is not known in the plane is 0, its variance 1 m^2.
shoal::estimate_t planar_estimate(std::int64_t utime, const Pose2& pose, const Eigen::Matrix2d& covariance_m2);

}  // namespace autonomy
