// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/ray_casting.hpp"

namespace devices {

std::vector<sim::Vector3d> cone_pattern(double half_angle_rad, int rays) {
  if (rays <= 1 || half_angle_rad == 0) return {sim::Vector3d::UnitX()};
  const double golden_angle_rad = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<sim::Vector3d> pattern;
  pattern.reserve(static_cast<std::size_t>(rays));
  for (int k = 0; k < rays; ++k) {
    // Equal steps of 1 - cos(angle) give equal solid angles.
    const double cosine = 1 - (1 - std::cos(half_angle_rad)) * (k + 0.5) / rays;
    const double sine = std::sqrt(1 - cosine * cosine);
    const double around_rad = k * golden_angle_rad;
    pattern.emplace_back(cosine, sine * std::cos(around_rad), sine * std::sin(around_rad));
  }
  return pattern;
}

double cone_solid_angle_sr(double half_angle_rad) {
  return 2 * std::numbers::pi * (1 - std::cos(half_angle_rad));
}

}  // namespace devices
