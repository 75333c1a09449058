// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/vector_field_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/base/math.hpp"

namespace autonomy {

namespace {

constexpr double sector_rad = 2 * std::numbers::pi / VectorFieldHistogram::sectors;

double direction_of_sector(int sector) {
  return sector * sector_rad;
}

}  // namespace

std::array<bool, VectorFieldHistogram::sectors> VectorFieldHistogram::blocked(
    const Motion& own, double speed_mps, double range_m, std::span<const Obstacle> obstacles) const {
  std::array<bool, sectors> blocked{};
  const double turn_radius_m = speed_mps / params_.turn_radps;
  // Limits of the directions that can be reached to both sides of the own heading.
  double port_rad = std::numbers::pi;
  double starboard_rad = -std::numbers::pi;
  for (const Obstacle& obstacle : obstacles) {
    const Vector2d d_W = obstacle.p_W - own.p_W;
    const double distance_m = d_W.norm();
    const double enlarged_m = obstacle.radius_m + params_.keep_m;
    if (distance_m > range_m + obstacle.radius_m) continue;
    const double bearing_rad = std::atan2(d_W.y(), d_W.x());
    const double half_rad = distance_m > enlarged_m ? std::asin(enlarged_m / distance_m) : 0.5 * std::numbers::pi;
    for (int i = 0; i < sectors; ++i)
      if (std::abs(sim::wrap_angle(direction_of_sector(i) - bearing_rad)) <= half_rad)
        blocked[static_cast<std::size_t>(i)] = true;
    // The circles of the tightest turns.
    const double off_rad = sim::wrap_angle(bearing_rad - own.yaw_rad);
    const Vector2d d_B = turned(d_W, -own.yaw_rad);
    const double reach_m = turn_radius_m + std::min(enlarged_m, distance_m);
    if (off_rad > 0 && (d_B - Vector2d(0, turn_radius_m)).norm() < reach_m) port_rad = std::min(port_rad, off_rad);
    if (off_rad <= 0 && (d_B + Vector2d(0, turn_radius_m)).norm() < reach_m)
      starboard_rad = std::max(starboard_rad, off_rad);
  }
  for (int i = 0; i < sectors; ++i) {
    const double off_rad = sim::wrap_angle(direction_of_sector(i) - own.yaw_rad);
    if (off_rad > port_rad || off_rad < starboard_rad) blocked[static_cast<std::size_t>(i)] = true;
  }
  return blocked;
}

Course VectorFieldHistogram::steer(const Motion& own, const Vector2d& drift_W, const Course& desired,
                                   std::span<const Obstacle> obstacles) {
  if (obstacles.empty() || desired.speed_mps <= 0) {
    last_rad_ = unknown;
    return desired;
  }
  const double speed_mps = std::max(desired.speed_mps, (own.v_W - drift_W).norm());
  const double range_m = params_.keep_m + std::min(params_.horizon_s * speed_mps, desired.distance_m);
  const auto is_blocked = blocked(own, speed_mps, range_m, obstacles);
  const double previous_rad = std::isfinite(last_rad_) ? last_rad_ : desired.heading_rad;
  const auto cost_of = [&](double direction_rad) {
    return 5 * std::abs(sim::wrap_angle(direction_rad - desired.heading_rad)) +
           2 * std::abs(sim::wrap_angle(direction_rad - own.yaw_rad)) +
           2 * std::abs(sim::wrap_angle(direction_rad - previous_rad));
  };
  double lowest = std::numeric_limits<double>::infinity();
  double chosen_rad = desired.heading_rad;
  for (int i = 0; i < sectors; ++i) {
    if (is_blocked[static_cast<std::size_t>(i)]) continue;
    const double direction_rad = sim::wrap_angle(direction_of_sector(i));
    // The desired heading itself, when it lies in this sector.
    const bool is_desired = std::abs(sim::wrap_angle(direction_rad - desired.heading_rad)) <= 0.5 * sector_rad;
    const double candidate_rad = is_desired ? desired.heading_rad : direction_rad;
    const double cost = cost_of(candidate_rad);
    if (cost >= lowest) continue;
    lowest = cost;
    chosen_rad = candidate_rad;
  }
  if (std::isfinite(lowest)) {
    last_rad_ = chosen_rad;
    // Slow in a sharp turn.
    const double ahead = std::max(0.0, std::cos(sim::wrap_angle(chosen_rad - own.yaw_rad)));
    return {std::max(params_.speed_min_mps, desired.speed_mps * (0.3 + 0.7 * ahead)), chosen_rad};
  }
  // No opening: away from the nearest obstacle, as slowly as it can be steered.
  const Obstacle* nearest = &obstacles.front();
  for (const Obstacle& obstacle : obstacles)
    if ((obstacle.p_W - own.p_W).norm() - obstacle.radius_m < (nearest->p_W - own.p_W).norm() - nearest->radius_m)
      nearest = &obstacle;
  const Vector2d away_W = own.p_W - nearest->p_W;
  return {params_.speed_min_mps, std::atan2(away_W.y(), away_W.x())};
}

}  // namespace autonomy
