// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/current.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/terrain/terrain.hpp"

namespace sim {

namespace {

Vector3d level(double speed, double direction_rad) {
  return {speed * std::cos(direction_rad), speed * std::sin(direction_rad), 0};
}

double tide_angle_rad(const TideConfig& tide, Time at) {
  return 2 * std::numbers::pi * to_seconds(at) / tide.period_s + tide.phase_rad;
}

Vector3d of_profile(const std::vector<CurrentLayerConfig>& rows, double depth_m) {
  if (depth_m <= rows.front().depth_m) return rows.front().velocity_mps;
  if (depth_m >= rows.back().depth_m) return rows.back().velocity_mps;
  const auto below =
      std::upper_bound(rows.begin(), rows.end(), depth_m, [](double d, const auto& row) { return d < row.depth_m; });
  const auto &a = below[-1], &b = *below;
  return a.velocity_mps + (b.velocity_mps - a.velocity_mps) * ((depth_m - a.depth_m) / (b.depth_m - a.depth_m));
}

/// Speed of a vortex relative to its peak, at a radius relative to that of the peak.
double vortex_speed(CurrentConfig::Core core, double ratio) {
  // Lamb-Oseen vortex normalized by its peak: d/dr of (1 - e^(-a r^2)) / r is 0 at r = 1 for a = 1.25643.
  constexpr double a = 1.2564312086261697;
  switch (core) {
    case CurrentConfig::Core::lamb_oseen:
      return (1 + 0.5 / a) / ratio * -std::expm1(-a * ratio * ratio);
    case CurrentConfig::Core::rankine:
      break;
  }
  return std::min(ratio, 1 / ratio);
}

}  // namespace

double power_law_speed_mps(double surface_speed_mps, double depth_m, double water_depth_m, double exponent) {
  const double share = std::clamp(1 - depth_m / water_depth_m, 0.0, 1.0);
  return share > 0 ? surface_speed_mps * std::pow(share, exponent) : 0;
}

double wind_driven_speed_mps(double surface_speed_mps, double depth_m, double reference_depth_m) {
  return surface_speed_mps * std::clamp(1 - depth_m / reference_depth_m, 0.0, 1.0);
}

Current::Current(const std::vector<CurrentConfig>& entries, const std::vector<TideConfig>& tides, std::uint64_t seed)
    : tides_(tides) {
  // Sort the entries by their dependence on time and position.
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const CurrentConfig& entry = entries[i];
    switch (entry.type) {
      case CurrentConfig::Type::constant:
        constant_W_ += entry.velocity_mps;
        break;
      case CurrentConfig::Type::profile:
      case CurrentConfig::Type::power_law:
      case CurrentConfig::Type::wind_driven:
        by_depth_.push_back(entry);
        break;
      case CurrentConfig::Type::gauss_markov: {
        const Vector3d std(entry.std_mps, entry.direction_std_rad, entry.vertical_std_mps);
        wandering_.push_back(
            {entry.speed_mps, entry.direction_rad,
             GaussMarkov(std, entry.correlation_time_s, Random(seed, "medium/current/" + std::to_string(i)))});
        break;
      }
      case CurrentConfig::Type::vortex:
        vortices_.push_back(
            {{entry.center_m[0], entry.center_m[1]}, entry.peak_speed_mps, entry.core_radius_m, entry.core});
        break;
      case CurrentConfig::Type::grid:
        try {
          grids_.emplace_back(entry);
        } catch (const TerrainError& error) {
          throw_config_error(entry.place, "medium: current " + std::to_string(i + 1), error.what());
        }
        break;
    }
  }
  // Note whether the velocity depends on position.
  varies_ = !by_depth_.empty() || !vortices_.empty() || !grids_.empty();
  advance_to(Time{0});
}

void Current::advance_to(Time now) {
  uniform_W_ = constant_W_;
  for (Wandering& part : wandering_) {
    part.errors.advance_to(now);
    const Vector3d& error = part.errors.values();
    uniform_W_ += level(part.speed_mps + error.x(), part.direction_rad + error.y());
    uniform_W_.z() += error.z();
  }
  for (const TideConfig& tide : tides_)
    if (tide.current_mps > 0)
      uniform_W_ += level(tide.current_mps * std::cos(tide_angle_rad(tide, now) + tide.current_lead_rad),
                          tide.current_direction_rad);
}

Vector3d Current::local_W(double x_m, double y_m, double depth_m) const {
  Vector3d sum = Vector3d::Zero();
  // Currents that depend on depth.
  for (const CurrentConfig& part : by_depth_) {
    switch (part.type) {
      case CurrentConfig::Type::profile:
        sum += of_profile(part.profile, depth_m);
        break;
      case CurrentConfig::Type::power_law:
        sum +=
            level(power_law_speed_mps(part.speed_mps, depth_m, part.water_depth_m, part.exponent), part.direction_rad);
        break;
      case CurrentConfig::Type::wind_driven:
        sum += level(wind_driven_speed_mps(part.speed_mps, depth_m, part.reference_depth_m), part.direction_rad);
        break;
      case CurrentConfig::Type::constant:
      case CurrentConfig::Type::gauss_markov:
      case CurrentConfig::Type::vortex:
      case CurrentConfig::Type::grid:
        break;  // none of by_depth_
    }
  }
  // Currents that depend on the horizontal position.
  for (const Vortex& vortex : vortices_) {
    const Eigen::Vector2d r = Eigen::Vector2d(x_m, y_m) - vortex.center_m;
    const double ratio = r.norm() / vortex.core_radius_m;
    if (ratio < 1e-9) continue;
    const double scale = vortex.peak_speed_mps * vortex_speed(vortex.core, ratio) / (ratio * vortex.core_radius_m);
    sum += Vector3d(-scale * r.y(), scale * r.x(), 0);
  }
  for (const CurrentGrid& grid : grids_) sum += grid.velocity_W(x_m, y_m);
  return sum;
}

bool Current::known(double x_m, double y_m) const {
  return std::all_of(grids_.begin(), grids_.end(), [&](const CurrentGrid& grid) { return grid.contains(x_m, y_m); });
}

double Current::tide_m(const std::vector<TideConfig>& tides, Time at) {
  double height_m = 0;
  for (const TideConfig& tide : tides) height_m += tide.amplitude_m * std::cos(tide_angle_rad(tide, at));
  return height_m;
}

}  // namespace sim
