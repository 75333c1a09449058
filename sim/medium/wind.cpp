// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/wind.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

double gust_time_s(const WindConfig& config) {
  const GustConfig& gusts = *config.gusts;
  if (gusts.length_m) return std::max(0.05, *gusts.length_m / config.mean_mps().norm());
  return gusts.correlation_time_s.value_or(10);
}

}  // namespace

Wind::Wind(const WindConfig& config, std::uint64_t seed) : config_(config), mean_W_(config.mean_mps()) {
  if (config.gusts)
    gusts_.emplace(Vector3d(config.gusts->std_mps, config.gusts->across_std_mps, config.gusts->vertical_std_mps),
                   gust_time_s(config), Random(seed, "medium/wind"));
  advance_to(Time{0});
}

void Wind::advance_to(Time now) {
  if (!gusts_) return;
  gusts_->advance_to(now);
  const double level = std::hypot(mean_W_.x(), mean_W_.y());
  const double east = level > 0 ? mean_W_.x() / level : 1, north = level > 0 ? mean_W_.y() / level : 0;
  const Vector3d& gust = gusts_->values();
  gust_W_ = {gust.x() * east - gust.y() * north, gust.x() * north + gust.y() * east, gust.z()};
}

Vector3d Wind::velocity_W(double height_m) const {
  double factor = 1;
  if (config_.profile == WindConfig::Profile::power)
    factor = std::pow(std::max(0.0, height_m) / config_.reference_height_m, config_.exponent);
  else if (config_.profile == WindConfig::Profile::log)
    factor = std::log(std::max(height_m, config_.roughness_m) / config_.roughness_m) /
             std::log(config_.reference_height_m / config_.roughness_m);
  return factor * mean_W_ + gust_W_;
}

}  // namespace sim
