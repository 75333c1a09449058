// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/waypoint_follower.hpp"

#include <limits>
#include <stdexcept>

namespace autonomy {

namespace {

/// A smaller change is noise, not progress.
constexpr double progress_m = 0.2;

}  // namespace

WaypointFollower::WaypointFollower(std::vector<Vector2d> waypoints_W, const Params& params)
    : params_(params), waypoints_W_(std::move(waypoints_W)), nearest_m_(std::numeric_limits<double>::infinity()) {
  if (waypoints_W_.empty()) throw std::invalid_argument("there must be at least one waypoint");
}

Vector2d WaypointFollower::goal_B(const Pose2& pose, double now_s) {
  const double distance_m = (waypoints_W_[current_] - pose.p_W).norm();
  if (distance_m < params_.reached_m) {
    ++reached_;
    next(now_s);
  } else if (distance_m < nearest_m_ - progress_m) {
    nearest_m_ = distance_m;
    nearest_at_s_ = now_s;
  } else if (now_s - nearest_at_s_ > params_.give_up_s) {
    // A waypoint inside of an obstacle must not hold up the rest of the route.
    ++given_up_;
    next(now_s);
  }
  return turned(waypoints_W_[current_] - pose.p_W, -pose.yaw_rad);
}

void WaypointFollower::next(double now_s) {
  current_ = (current_ + 1) % waypoints_W_.size();
  nearest_m_ = std::numeric_limits<double>::infinity();
  nearest_at_s_ = now_s;
}

}  // namespace autonomy
