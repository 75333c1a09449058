// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/ray_casting.hpp"

#include <spdlog/fmt/fmt.h>

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

sim::RayFilter make_ray_filter(const sim::PhysicsWorld& physics, sim::RayKind kind,
                               const std::vector<std::string>& see_through, int own_group, bool sees_own_vehicle) {
  sim::RayFilter filter;
  filter.kind = kind;
  for (const std::string& category : see_through) filter.categories &= ~physics.category_bit(category);
  if (!sees_own_vehicle) filter.exclude_group = own_group;
  return filter;
}

namespace {

constexpr double max_rays = 1e6;

}  // namespace

void check_rays(sim::ParamReader& in, std::span<const RayFactor> factors) {
  double rays = 1;
  std::string keys, counts;
  const char* last_given = nullptr;
  for (const RayFactor& factor : factors) {
    const std::string between = keys.empty() ? "" : " x ";
    rays *= factor.count;
    keys += between + "'" + factor.key + "'";
    counts += between + fmt::format("{:.0f}", factor.count);
    if (in.has(factor.key.c_str())) last_given = factor.key.c_str();
  }
  if (rays <= max_rays) return;
  const std::string text =
      fmt::format("{} must be at most {:.0f} rays in a sample, got {} = {:.0f}", keys, max_rays, counts, rays);
  // At the key given last, the one most likely to be changed; else the defaults alone are too many.
  last_given ? in.error(last_given, text) : in.error(text);
}

double rate_hz_of(const sim::ParamReader& in, double default_rate_hz) {
  double rate_hz = default_rate_hz;
  if (in.node() == nullptr) return rate_hz;
  sim::Diagnostics reported_elsewhere;
  sim::ParamReader again(*in.node(), in.who(), reported_elsewhere);
  again.read_or_word("rate_hz", rate_hz, sim::between(1e-6, 1e6), {"every_step"}, "");
  return rate_hz;
}

}  // namespace devices
