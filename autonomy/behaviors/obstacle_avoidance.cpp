// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/obstacle_avoidance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/math.hpp"

namespace autonomy {

namespace {

constexpr double direction_step_rad = 5 * std::numbers::pi / 180;
constexpr int directions_each_side = 16;  // up to 80 degrees; the fan ends at 90

}  // namespace

double ObstacleAvoidance::free_distance_m(const Scan& scan, double direction_rad) const {
  double free_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range_m = scan.ranges_m[i];
    const double angle = scan.first_angle_rad + static_cast<double>(i) * scan.step_rad - direction_rad;
    const double ahead_m = range_m * std::cos(angle);
    if (ahead_m > 0 && std::abs(range_m * std::sin(angle)) < params_.half_width_m) free_m = std::min(free_m, ahead_m);
  }
  return free_m;
}

bool ObstacleAvoidance::choose_direction(const Vector2d& goal_B, const Scan& scan, double& direction_rad) const {
  const double goal_rad = std::atan2(goal_B.y(), goal_B.x());
  const double needed_m = std::min(params_.look_ahead_m, goal_B.norm() + params_.half_width_m);
  // Preferring the last choice prevents oscillation in front of an obstacle.  The small preference for the right makes
  // two rovers that meet pass each other on the same side.
  constexpr double habit = 0.3;
  constexpr double keep_right_rad = 0.02;
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = -directions_each_side; i <= directions_each_side; ++i) {
    const double candidate = i * direction_step_rad;
    if (free_distance_m(scan, candidate) < needed_m) continue;
    const double cost = std::abs(sim::wrap_angle(candidate - goal_rad)) +
                        habit * std::abs(candidate - last_direction_rad_) + (candidate > 0 ? keep_right_rad : 0.0);
    if (cost >= lowest) continue;
    lowest = cost;
    direction_rad = candidate;
  }
  return std::isfinite(lowest);
}

Twist ObstacleAvoidance::turn_out(const Scan& scan) {
  // The side is chosen once and kept until the way is free: choosing again at every scan, the rover would turn back and
  // forth.
  if (turning_out_ == 0) {
    double left_m = 0;
    double right_m = 0;
    for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
      const double angle = scan.first_angle_rad + static_cast<double>(i) * scan.step_rad;
      (angle > 0 ? left_m : right_m) += scan.ranges_m[i];
    }
    turning_out_ = left_m > right_m ? 1 : -1;
  }
  return {0, turning_out_ * params_.max_turn_radps};
}

Twist ObstacleAvoidance::steer(const Vector2d& goal_B, const Scan& scan) {
  double direction_rad = 0;
  // It turns on the spot in the same sense until the way ahead is free; otherwise the two sides of a corner would make
  // it oscillate.
  const bool out = turning_out_ == 0 || free_distance_m(scan, 0) >= params_.slow_m;
  if (!out || !choose_direction(goal_B, scan, direction_rad)) return turn_out(scan);
  turning_out_ = 0;
  last_direction_rad_ = direction_rad;
  const double turn = std::clamp(1.5 * direction_rad, -params_.max_turn_radps, params_.max_turn_radps);
  const double ahead_m = free_distance_m(scan, 0);
  const double room = std::clamp((ahead_m - params_.stop_m) / (params_.slow_m - params_.stop_m), 0.0, 1.0);
  // Slow in a sharp turn: the wheels must not slip, and obstacles beside the lane come close.
  const double straightness = std::max(0.0, std::cos(direction_rad));
  return {params_.speed_mps * room * straightness, turn};
}

}  // namespace autonomy
