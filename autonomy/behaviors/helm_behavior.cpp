// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/helm_behavior.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/base/math.hpp"

namespace autonomy {

namespace {

double direction_of(const Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

/// Speed below which the course is only noise.
constexpr double min_speed_mps = 0.2;

}  // namespace

RouteBehavior::RouteBehavior(std::vector<Vector2d> waypoints_W, const Params& params)
    : params_(params), waypoints_W_(std::move(waypoints_W)) {
  if (waypoints_W_.empty()) throw std::invalid_argument("a route needs a waypoint");
}

bool RouteBehavior::is_reached(const Vector2d& p_W) const {
  const Vector2d& goal_W = waypoints_W_[current_];
  const Vector2d leg_W = goal_W - *from_W_;
  if ((goal_W - p_W).norm() <= params_.reached_m) return true;
  return leg_W.norm() > params_.reached_m && (goal_W - p_W).dot(leg_W) <= 0;
}

Course RouteBehavior::steer(const Motion& own) {
  if (!from_W_) from_W_ = own.p_W;
  // Each waypoint at most once per call: on a route of a single or of equal points, all are reached immediately.
  for (std::size_t i = 0; i < waypoints_W_.size() && !finished() && is_reached(own.p_W); ++i) {
    from_W_ = waypoints_W_[current_++];
    if (finished() && params_.loop) current_ = 0;
  }
  if (finished()) return {0, heading_rad_};
  const Vector2d leg_W = waypoints_W_[current_] - *from_W_;
  const double leg_rad = direction_of(leg_W);
  const double across_m = turned(own.p_W - *from_W_, -leg_rad).y();
  heading_rad_ = sim::wrap_angle(leg_rad - std::atan2(across_m, params_.lookahead_m));
  return {params_.speed_mps, heading_rad_, (waypoints_W_[current_] - own.p_W).norm()};
}

Course CircleBehavior::steer(const Motion& own) {
  const Vector2d d_W = own.p_W - params_.center_W;
  const double outwards_m = d_W.norm() - params_.radius_m;
  const double tangent_rad = (d_W.norm() > 0 ? direction_of(d_W) : 0.0) + 0.5 * std::numbers::pi;
  const double in_rad = std::atan2(outwards_m, params_.lookahead_m);
  return {params_.speed_mps, sim::wrap_angle(tangent_rad + in_rad)};
}

HoldBehavior::HoldBehavior(const CircleBehavior::Params& hold)
    : path_({hold.center_W}, {.speed_mps = hold.speed_mps, .lookahead_m = hold.lookahead_m}), circle_(hold) {}

Course HoldBehavior::steer(const Motion& own) {
  const Course course = path_.steer(own);
  return path_.finished() ? circle_.steer(own) : course;
}

void FollowBehavior::receive_state(const std::string& vehicle, const Motion& other) {
  if (vehicle != params_.vehicle) return;
  // Much older: the clock of the other vehicle was set back.
  constexpr std::int64_t oldest_us = 60'000'000;
  if (other_ && other.utime <= other_->utime && other.utime > other_->utime - oldest_us) return;
  other_ = other;
  if (other.v_W.norm() > min_speed_mps) other_course_rad_ = direction_of(other.v_W);
}

std::string FollowBehavior::remark() const {
  return other_ ? "" : "it has received no message from '" + params_.vehicle + "', which it was to follow";
}

std::optional<Vector2d> FollowBehavior::place_W(std::int64_t utime) const {
  if (!other_) return std::nullopt;
  const double age_s = static_cast<double>(utime - other_->utime) * 1e-6;
  if (std::abs(age_s) > params_.discard_after_s) return std::nullopt;
  return Vector2d(other_->p_W + other_->v_W * age_s + turned({params_.ahead_m, params_.left_m}, other_course_rad_));
}

Course FollowBehavior::steer(const Motion& own) {
  const auto goal_W = place_W(own.utime);
  if (!goal_W) return {0, direction_of(own.v_W)};
  const Vector2d error_W = *goal_W - own.p_W;
  const double other_mps = other_->v_W.norm();
  const double near_m = (other_mps > min_speed_mps ? 4 : 1) * params_.lookahead_m;
  // Far away, it moves straight to the position.
  if (error_W.norm() > near_m) return {params_.speed_max_mps, direction_of(error_W)};
  // Near the position it moves parallel to the other's course; when it is ahead it waits, and does not turn around.
  const Vector2d error_C = turned(error_W, -other_course_rad_);
  const Vector2d aim_C(std::max(error_C.x(), 0.0) + params_.lookahead_m, error_C.y());
  const double desired_mps = other_mps + params_.catch_up_per_s * error_C.x();
  return {std::clamp(desired_mps, 0.0, params_.speed_max_mps), direction_of(turned(aim_C, other_course_rad_))};
}

std::vector<Vector2d> zigzag(const Vector2d& from_W, const Vector2d& to_W, double amplitude_m, int legs) {
  if (legs < 1 || legs > 10'000) throw std::invalid_argument("a zigzag has 1 to 10000 legs");
  const Vector2d displacement_W = to_W - from_W;
  const Vector2d left_W = turned({0, amplitude_m}, direction_of(displacement_W));
  std::vector<Vector2d> waypoints;
  for (int i = 0; i < legs; ++i)
    waypoints.push_back(from_W + (i + 0.5) / legs * displacement_W + (i % 2 == 0 ? 1 : -1) * left_W);
  waypoints.push_back(to_W);
  return waypoints;
}

}  // namespace autonomy
