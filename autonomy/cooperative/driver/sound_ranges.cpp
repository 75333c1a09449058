// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/sound_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace navigation {

namespace {

constexpr double layer_m = 1;
constexpr double deepest_m = 2000;
/// Of the layers in which rays are arcs: ranges of 2 km are right to some millimeters.
constexpr double speed_tolerance_mps = 1e-3;

}  // namespace

SoundRanges::SoundRanges(double speed_mps)
    : speeds_mps_{speed_mps},
      rays_(std::make_shared<sim::Eigenrays>(sim::SoundProfile({{0, speed_mps}, {deepest_m, speed_mps}}))) {}

SoundRanges::SoundRanges(const sim::Medium& medium) : SoundRanges() {
  if (!medium.has_water()) return;
  const auto speed_mps = [&](double depth_m) { return medium.sound_speed_at_depth_mps(depth_m); };
  speeds_mps_.clear();
  for (double depth_m = 0.5 * layer_m; depth_m < deepest_m; depth_m += layer_m)
    speeds_mps_.push_back(speed_mps(depth_m));
  rays_ = std::make_shared<sim::Eigenrays>(
      sim::SoundProfile::fitted(speed_mps, medium.profile_depths_m(), deepest_m, speed_tolerance_mps));
}

double SoundRanges::mean_speed_mps(double depth_a_m, double depth_b_m) const {
  const auto layer = [&](double depth_m) {
    const double index = std::floor(std::max(depth_m, 0.0) / layer_m);
    return index < static_cast<double>(speeds_mps_.size()) ? static_cast<std::size_t>(index) : speeds_mps_.size() - 1;
  };
  const std::size_t a = layer(depth_a_m), b = layer(depth_b_m);
  const std::size_t from = std::min(a, b), to = std::max(a, b);
  double slowness = 0;
  for (std::size_t i = from; i <= to; ++i) slowness += 1 / speeds_mps_[i];
  return static_cast<double>(to - from + 1) / slowness;
}

std::optional<double> SoundRanges::direct_time_s(double range_m, double depth_a_m, double depth_b_m) const {
  const double down_m = depth_a_m - depth_b_m;
  sim::RayQuery query;
  query.source_m = depth_a_m;
  query.receiver_m = depth_b_m;
  query.range_m = std::sqrt(std::max(0.0, (range_m - down_m) * (range_m + down_m)));
  query.water_m = std::numeric_limits<double>::infinity();
  std::vector<sim::SoundRay> rays;
  rays_->find(query, rays);
  if (rays.empty()) return std::nullopt;
  return rays.front().travel_time_s;
}

std::optional<double> SoundRanges::range_m(SoundModel model, double travel_time_s, double depth_a_m,
                                           double depth_b_m) const {
  double range_m = travel_time_s * mean_speed_mps(depth_a_m, depth_b_m);
  // No ray is shorter than the vertical one, which is straight.
  if (model == SoundModel::straight || range_m <= std::abs(depth_a_m - depth_b_m)) return range_m;
  // No ray takes more time than the straight line (Fermat): the point is farther than this, and never darker.  The time
  // is nearly proportional to the range: each iteration divides the error by 100 or more.
  constexpr int max_iterations = 10;
  constexpr double tolerance_m = 1e-3;
  for (int i = 0; i < max_iterations; ++i) {
    const auto time_s = direct_time_s(range_m, depth_a_m, depth_b_m);
    if (!time_s) return std::nullopt;
    const double correction_m = (travel_time_s / *time_s - 1) * range_m;
    range_m += correction_m;
    if (std::abs(correction_m) < tolerance_m) return range_m;
  }
  return std::nullopt;
}

}  // namespace navigation
