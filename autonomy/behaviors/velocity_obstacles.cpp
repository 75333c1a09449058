// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/velocity_obstacles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "sim/base/math.hpp"

namespace autonomy {

namespace {

// Weights of the cost, relative to a deviation as large as the desired speed.
constexpr double collision_weight_s = 10;
constexpr double near_weight = 0.5;
constexpr double port_weight = 0.1;
constexpr double habit_weight = 0.3;

}  // namespace

VelocityObstacles::Outcome VelocityObstacles::outcome(const Motion& own, const Vector2d& drift_W, const Course& control,
                                                      std::span<const Obstacle> obstacles) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Outcome outcome{infinity, infinity};
  // An obstacle that is closer already must not come closer still.
  std::vector<double> limit_m;
  for (const Obstacle& obstacle : obstacles)
    limit_m.push_back(std::min(params_.keep_m, (obstacle.p_W - own.p_W).norm() - obstacle.radius_m - 0.01));
  Vector2d p_W = own.p_W;
  double yaw_rad = own.yaw_rad;
  double speed_mps = std::max(0.0, (own.v_W - drift_W).dot(turned({1, 0}, own.yaw_rad)));
  double travelled_m = 0;
  const int steps = static_cast<int>(params_.horizon_s / step_s);
  for (int i = 1; i <= steps; ++i) {
    const double error_rad = sim::wrap_angle(control.heading_rad - yaw_rad);
    yaw_rad += std::clamp(error_rad, -params_.turn_radps * step_s, params_.turn_radps * step_s);
    speed_mps += (control.speed_mps - speed_mps) * std::min(1.0, step_s / params_.speed_time_s);
    p_W += (turned({speed_mps, 0}, yaw_rad) + drift_W) * step_s;
    travelled_m += speed_mps * step_s;
    const double t_s = i * step_s;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      const Obstacle& obstacle = obstacles[k];
      if (travelled_m > control.distance_m && obstacle.v_W.isZero()) continue;
      const double distance_m = (obstacle.p_W + obstacle.v_W * t_s - p_W).norm() - obstacle.radius_m;
      outcome.clearance_m = std::min(outcome.clearance_m, distance_m - params_.keep_m);
      if (distance_m < limit_m[k]) outcome.collision_s = std::min(outcome.collision_s, t_s);
    }
    if (outcome.collision_s <= t_s) break;
  }
  return outcome;
}

Course VelocityObstacles::steer(const Motion& own, const Vector2d& drift_W, const Course& desired,
                                std::span<const Obstacle> obstacles) {
  if (obstacles.empty() || desired.speed_mps <= 0) {
    last_turn_rad_ = 0;
    return desired;
  }
  constexpr std::array<double, 4> speed_shares = {1, 0.6, 0.3, 0};
  Course best = desired;
  double lowest = std::numeric_limits<double>::infinity();
  double best_turn_rad = 0;
  for (const double share : speed_shares) {
    const double speed_mps = std::min(desired.speed_mps, std::max(share * desired.speed_mps, params_.speed_min_mps));
    for (int i = -headings / 2; i < headings / 2; ++i) {
      const double turn_rad = 2 * std::numbers::pi * i / headings;
      const Course control{speed_mps, sim::wrap_angle(desired.heading_rad + turn_rad), desired.distance_m};
      const double s = speed_mps / desired.speed_mps;
      double cost = (turned({s, 0}, turn_rad) - Vector2d(1, 0)).norm();
      // To starboard if nothing speaks against it: two vehicles with this preference pass each other (COLREGs, rule
      // 14).
      cost += turn_rad > 0 ? port_weight : 0.0;
      // Without the habit it would dither between two sides of equal cost.
      cost += habit_weight * std::abs(sim::wrap_angle(turn_rad - last_turn_rad_)) / std::numbers::pi;
      // The other terms only add to the cost, so most courses are ruled out before the expensive prediction.
      if (cost >= lowest) continue;
      const Outcome result = outcome(own, drift_W, control, obstacles);
      cost += collision_weight_s / result.collision_s;
      cost += near_weight * std::clamp(1 - result.clearance_m / params_.keep_m, 0.0, 1.0);
      if (cost >= lowest) continue;
      lowest = cost;
      best = control;
      best_turn_rad = turn_rad;
    }
    if (speed_mps <= params_.speed_min_mps) break;
  }
  last_turn_rad_ = best_turn_rad;
  return best;
}

}  // namespace autonomy
