// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "autonomy/filters/pose2.hpp"
#include "autonomy/mapping/occupancy_map.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"

namespace test {

using autonomy::Pose2;
using autonomy::Vector2d;

/// Walls in the plane, seen by a lidar without errors.
struct DrawnRoom {
  std::vector<std::pair<Vector2d, Vector2d>> walls;

  void add_box(const Vector2d& low, const Vector2d& high) {
    const Vector2d b(high.x(), low.y()), d(low.x(), high.y());
    walls.insert(walls.end(), {{low, b}, {b, high}, {high, d}, {d, low}});
  }
  /// Returns the distance along a ray to the first wall; 20 m without any.
  double range_m(const Vector2d& from, double angle_rad) const {
    const Vector2d u(std::cos(angle_rad), std::sin(angle_rad));
    double range = 20;
    for (const auto& [a, b] : walls) {
      // from + t u = a + s (b - a).
      const Vector2d w = b - a, to = a - from;
      const double det = u.x() * -w.y() + w.x() * u.y();
      if (std::abs(det) < 1e-12) continue;
      const double t = (to.x() * -w.y() + w.x() * to.y()) / det, s = (u.x() * to.y() - u.y() * to.x()) / det;
      if (t > 0 && s >= 0 && s <= 1) range = std::min(range, t);
    }
    return range;
  }
  /// A scan of 180 beams to the front.
  shoal::planar_lidar_t scan(const Pose2& pose, std::int64_t utime) const {
    shoal::planar_lidar_t scan{};
    scan.utime = utime;
    scan.nranges = 180;
    scan.rad0 = static_cast<float>(-std::numbers::pi / 2);
    scan.radstep = static_cast<float>(std::numbers::pi / 179);
    for (int i = 0; i < scan.nranges; ++i)
      scan.ranges.push_back(static_cast<float>(
          range_m(pose.p_W, pose.yaw_rad + static_cast<double>(scan.rad0 + static_cast<float>(i) * scan.radstep))));
    return scan;
  }
};

/// A hall of 16 x 10 m with a pillar and two boxes: no two places look the same.  Its surfaces are in the middle of
/// cells of 0.05 m, because a surface on the border of two cells is half a cell off in a map.
inline DrawnRoom hall() {
  constexpr double half_cell_m = 0.025;
  DrawnRoom room;
  for (const auto& [low, high] : {std::pair{Vector2d(-8, -5), Vector2d(8, 5)},
                                  {Vector2d(-5, 2), Vector2d(-3, 4)},
                                  {Vector2d(2, -4), Vector2d(5, -3)},
                                  {Vector2d(5.5, 1), Vector2d(6, 1.5)}})
    room.add_box(low + Vector2d::Constant(half_cell_m), high + Vector2d::Constant(half_cell_m));
  return room;
}

inline shoal::odometry_t odometry_at(const Pose2& pose, std::int64_t utime) {
  shoal::odometry_t odometry{};
  odometry.utime = utime;
  odometry.x_m = pose.p_W.x();
  odometry.y_m = pose.p_W.y();
  odometry.theta_rad = pose.yaw_rad;
  return odometry;
}

/// Returns the ends of the beams that met something, in the frame of the lidar.
inline std::vector<Vector2d> points_of(const shoal::planar_lidar_t& scan) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle = static_cast<double>(scan.rad0) + static_cast<double>(i) * static_cast<double>(scan.radstep);
    if (scan.ranges[i] < 19.9F)
      points.emplace_back(static_cast<double>(scan.ranges[i]) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

/// The map of the hall, seen from many places.
inline autonomy::OccupancyMap hall_map() {
  autonomy::OccupancyMap::Params params;
  params.low_W = {-9, -6};
  params.high_W = {9, 6};
  autonomy::OccupancyMap map(params);
  for (const Vector2d& from : {Vector2d(-6, -2), Vector2d(0, 0), Vector2d(6, -1), Vector2d(3, 3), Vector2d(-6, 3)})
    for (const double yaw_rad : {0.0, 1.5, 3.0, 4.5}) {
      std::vector<Vector2d> ends;
      for (const Vector2d& point : points_of(hall().scan({from, yaw_rad}, 0)))
        ends.push_back(from + autonomy::turned(point, yaw_rad));
      for (int times = 0; times < 3; ++times) map.insert(from, ends, std::vector<char>(ends.size(), 1), 0);
    }
  return map;
}

}  // namespace test
