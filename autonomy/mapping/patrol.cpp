// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/patrol.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace autonomy {

namespace {

/// Odometry is kept for this long; an older estimate is not used.
constexpr double memory_s = 10;

ObstacleAvoidance::Params avoidance_params(const Patrol::Params& params) {
  ObstacleAvoidance::Params avoidance;
  avoidance.speed_mps = params.speed_mps;
  return avoidance;
}

}  // namespace

Patrol::Patrol(const Params& params) : params_(params), avoidance_(avoidance_params(params)) {
  if (!params.waypoints_W.empty())
    follower_.emplace(params.waypoints_W,
                      WaypointFollower::Params{.reached_m = params.reached_m, .give_up_s = params.give_up_s});
}

void Patrol::receive(const shoal::odometry_t& odometry) {
  odometry_.emplace_back(odometry.utime, Pose2{{odometry.x_m, odometry.y_m}, odometry.theta_rad});
  while (seconds(odometry.utime - odometry_.front().first) > memory_s) odometry_.pop_front();
}

void Patrol::receive(const shoal::planar_lidar_t& scan) {
  scan_ = {scan.ranges, static_cast<double>(scan.rad0), static_cast<double>(scan.radstep)};
  scan_utime_ = scan.utime;
}

void Patrol::receive(const shoal::estimate_t& estimate) {
  estimate_ = estimate;
}

Pose2 Patrol::present_pose() const {
  const Pose2 estimated{{estimate_->position_m[0], estimate_->position_m[1]}, estimate_->yaw_rad};
  const auto then = std::find_if(odometry_.begin(), odometry_.end(),
                                 [&](const auto& each) { return each.first >= estimate_->utime; });
  if (then == odometry_.end()) return estimated;
  const Pose2 &before = then->second, &now = odometry_.back().second;
  const Vector2d moved_B = turned(now.p_W - before.p_W, -before.yaw_rad);
  return {estimated.p_W + turned(moved_B, estimated.yaw_rad), estimated.yaw_rad + now.yaw_rad - before.yaw_rad};
}

Twist Patrol::step(std::int64_t utime) {
  // A decision needs a pose and a scan of the last periods.
  if (!estimate_ || odometry_.empty() || scan_.ranges_m.empty()) return {};
  const std::int64_t newest = odometry_.back().first;
  if (newest != newest_utime_) {
    newest_utime_ = newest;
    newest_tick_ = utime;
  }
  const double oldest_s = 2.5 * params_.period_s;
  if (seconds(utime - newest_tick_) > oldest_s) return {};
  if (seconds(newest - scan_utime_) > oldest_s || seconds(newest - estimate_->utime) > memory_s) return {};
  const double variance_m2 = estimate_->covariance_m2[0] + estimate_->covariance_m2[4];
  if (!(variance_m2 < 2 * squared(params_.lost_std_m))) return seek_place(utime);
  lost_since_.reset();
  return follower_ ? to_waypoint(utime) : along_path();
}

Twist Patrol::along_path() {
  if (path_W_.empty()) return {};
  const Pose2 pose = present_pose();
  if ((path_W_.back() - pose.p_W).norm() < 0.5 * params_.reached_m)
    return {0, path_W_.size() == 1 ? params_.search_radps : 0};
  const Vector2d ahead_W = ahead_on(path_W_, nearest_on(path_W_, pose.p_W), params_.ahead_m);
  return steer(turned(ahead_W - pose.p_W, -pose.yaw_rad));
}

Twist Patrol::to_waypoint(std::int64_t utime) {
  if (utime < rests_until_) return {};
  const Vector2d goal_B = follower_->goal_B(present_pose(), seconds(utime));
  if (follower_->reached() + follower_->given_up() > passed_) {
    const bool reached = follower_->reached() > reached_;
    passed_ = follower_->reached() + follower_->given_up();
    reached_ = follower_->reached();
    // A waypoint that was given up needs no rest.
    if (!reached) return {};
    const bool charges = follower_->current() == 1 % params_.waypoints_W.size();
    rounds_ += charges && reached_ > 1 ? 1 : 0;
    rests_until_ = utime + static_cast<std::int64_t>(1e6 * (charges ? params_.charge_s : params_.pause_s));
    return {};
  }
  return steer(goal_B);
}

Twist Patrol::steer(const Vector2d& goal_B) {
  Twist twist = avoidance_.steer(goal_B, scan_);
  // The gain of 1.5 /s would overshoot when a command lasts longer: two thirds of the error in a period are enough.
  twist.turn_radps *= std::min(1.0, 0.67 / (1.5 * params_.period_s));
  return twist;
}

Twist Patrol::seek_place(std::int64_t utime) {
  if (!lost_since_) lost_since_ = utime;
  const double turn_s = 2 * std::numbers::pi / params_.search_radps;
  const double at_s = std::fmod(seconds(utime - *lost_since_), turn_s + params_.search_drive_s);
  if (at_s < turn_s) return {0, params_.search_radps};
  return steer({params_.speed_mps * params_.search_drive_s, 0});
}

}  // namespace autonomy
