// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/lidar_odometry.hpp"

#include <algorithm>
#include <cmath>

#include "autonomy/mapping/pose_graph.hpp"
#include "shoal/message_codec.hpp"

namespace autonomy {

Beams beams_of(const shoal::planar_lidar_t& scan, const LidarMount& lidar) {
  Beams beams;
  beams.sensor_B = lidar.pose.p_W;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range_m = static_cast<double>(scan.ranges[i]);
    if (!(range_m > 0)) continue;
    // A range of nearly the maximum is a miss: the scanner reports that value for it.
    const bool hit = range_m < 0.99 * lidar.range_m && range_m <= lidar.use_range_m;
    const double angle_rad =
        static_cast<double>(scan.rad0) + static_cast<double>(i) * static_cast<double>(scan.radstep);
    const double length_m = std::min(range_m, lidar.use_range_m);
    beams.ends_B.push_back(placed(lidar.pose, length_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad))));
    beams.hits.push_back(hit ? 1 : 0);
    if (hit) beams.points_B.push_back(beams.ends_B.back());
  }
  return beams;
}

std::vector<Vector2d> ends_W_of(const Beams& beams, const Pose2& pose) {
  std::vector<Vector2d> ends_W;
  ends_W.reserve(beams.ends_B.size());
  for (const Vector2d& end : beams.ends_B) ends_W.push_back(placed(pose, end));
  return ends_W;
}

Vector2d placed(const Pose2& pose, const Vector2d& p_B) {
  return pose.p_W + turned(p_B, pose.yaw_rad);
}

Pose2 moved(const Pose2& pose, const Increment& by) {
  return composed(pose, {{by.forward_m, by.left_m}, by.turn_rad});
}

void check_reachable(const shoal::odometry_t& odometry) {
  constexpr double farthest_m = 1e6, fastest = 1e3;
  if (std::hypot(odometry.x_m, odometry.y_m) > farthest_m || std::abs(odometry.theta_rad) > farthest_m ||
      std::abs(odometry.forward_mps) > fastest || std::abs(odometry.turn_radps) > fastest)
    throw shoal::MessageError("odometry must be within 1e6 m, 1e6 rad, 1e3 m/s and 1e3 rad/s");
}

Increment moved_until(std::int64_t utime, const shoal::odometry_t& odometry, Odometer& odometer) {
  const double dt_s = std::clamp(seconds(utime - odometry.utime), -1.0, 1.0);
  const double theta_rad = odometry.theta_rad + odometry.turn_radps * dt_s;
  const Vector2d p = Vector2d(odometry.x_m, odometry.y_m) + turned({odometry.forward_mps * dt_s, 0}, theta_rad);
  return odometer.update(p, theta_rad);
}

shoal::estimate_t planar_estimate(std::int64_t utime, const Pose2& pose, const Eigen::Matrix2d& covariance_m2) {
  shoal::estimate_t message{};
  message.utime = utime;
  message.position_m[0] = pose.p_W.x();
  message.position_m[1] = pose.p_W.y();
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 2; ++column) message.covariance_m2[3 * row + column] = covariance_m2(row, column);
  // The height is unknown, but the covariance must be positive definite.
  message.covariance_m2[8] = 1;
  message.yaw_rad = pose.yaw_rad;
  message.clock_error_s = unknown;
  return message;
}

}  // namespace autonomy
