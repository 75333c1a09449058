// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "autonomy/filters/pose2.hpp"

namespace autonomy {

/// Follows a list of waypoints in a loop.
class WaypointFollower {
 public:
  struct Params {
    double reached_m = 1.0;   ///< acceptance radius of a waypoint
    double give_up_s = 30.0;  ///< a waypoint is skipped after this time without progress, because it may be occupied
  };

  /// Throws std::invalid_argument without waypoints.
  WaypointFollower(std::vector<Vector2d> waypoints_W, const Params& params);
  explicit WaypointFollower(std::vector<Vector2d> waypoints_W) : WaypointFollower(std::move(waypoints_W), Params()) {}

  /// Returns the next goal in the body frame of the rover.  `now_s` must not decrease.
  Vector2d goal_B(const Pose2& pose, double now_s);
  std::size_t current() const { return current_; }
  int reached() const { return reached_; }
  int given_up() const { return given_up_; }

 private:
  void next(double now_s);

  Params params_;
  std::vector<Vector2d> waypoints_W_;
  std::size_t current_ = 0;
  double nearest_m_;
  double nearest_at_s_ = 0;
  int reached_ = 0;
  int given_up_ = 0;
};

}  // namespace autonomy
