// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/water_column.hpp"

#include <algorithm>
#include <cmath>

#include "sim/medium/sea_water.hpp"

namespace sim {
namespace {

constexpr double deepest_m = 12000;
constexpr double spacing_m = 20;  ///< of the rows for the integration of the pressure

double mix(double a, double b, double share) {
  return a + (b - a) * share;
}

}  // namespace

WaterColumn::WaterColumn(const WaterConfig& config, double gravity_mps2)
    : config_(config), gravity_mps2_(gravity_mps2) {
  const bool density_rows = !config.profile.empty() && config.profile[0].density_kgpm3;
  same_density_ = config.density == WaterConfig::Density::constant && !density_rows;
  // Rows of the configuration.
  std::vector<Row> given;
  if (config.profile.empty())
    given.push_back({0, config.temperature_C, config.salinity_psu, 0, config.density_kgpm3, 0});
  for (const WaterLayerConfig& layer : config.profile)
    given.push_back({layer.depth_m, layer.temperature_C, layer.salinity_psu, layer.sound_speed_mps.value_or(0),
                     layer.density_kgpm3.value_or(config.density_kgpm3), 0});
  // Refine them to a spacing for the integration of the pressure, from the surface on.
  Row top = given[0];
  top.depth_m = 0;
  std::vector<Row> all{top};
  const auto fill_to = [&](const Row& next) {
    const Row last = all.back();
    const double gap_m = next.depth_m - last.depth_m;
    // Close enough for the trapezoidal integration of the pressure below.
    const int pieces = std::max(1, static_cast<int>(std::ceil(gap_m / spacing_m)));
    for (int i = 1; gap_m > 0 && i <= pieces; ++i) {
      const double share = static_cast<double>(i) / pieces;
      all.push_back({mix(last.depth_m, next.depth_m, share), mix(last.temperature_C, next.temperature_C, share),
                     mix(last.salinity_psu, next.salinity_psu, share),
                     mix(last.sound_speed_mps, next.sound_speed_mps, share),
                     mix(last.density_kgpm3, next.density_kgpm3, share), 0});
    }
  };
  for (const Row& row : given) fill_to(row);
  if (config.density == WaterConfig::Density::eos80) {
    Row bottom = given.back();
    bottom.depth_m = deepest_m;
    fill_to(bottom);
  }
  rows_ = all;
  integrate();
}

void WaterColumn::integrate() {
  const bool eos80 = config_.density == WaterConfig::Density::eos80;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    if (i == 0) {
      if (eos80) row.density_kgpm3 = eos80_kgpm3(row.temperature_C, row.salinity_psu, 0);
      continue;
    }
    const Row& above = rows_[i - 1];
    const double weight = gravity_mps2_ * (row.depth_m - above.depth_m);
    // Density and pressure depend on each other; as 20 m of water compress it by 1e-4, the iteration converges at once.
    double density = eos80 ? above.density_kgpm3 : row.density_kgpm3;
    for (int round = 0; round < 4; ++round) {
      row.pressure_Pa = above.pressure_Pa + weight * (above.density_kgpm3 + density) / 2;
      if (eos80) density = eos80_kgpm3(row.temperature_C, row.salinity_psu, row.pressure_Pa / dbar_Pa);
    }
    row.density_kgpm3 = density;
  }
}

WaterColumn::Row WaterColumn::row_at(double depth_m) const {
  if (rows_.size() == 1 || depth_m <= 0) return rows_.front();
  if (depth_m >= rows_.back().depth_m) return rows_.back();
  const auto below =
      std::upper_bound(rows_.begin(), rows_.end(), depth_m, [](double d, const Row& row) { return d < row.depth_m; });
  const Row &a = below[-1], &b = *below;
  const double share = (depth_m - a.depth_m) / (b.depth_m - a.depth_m);
  const double density = mix(a.density_kgpm3, b.density_kgpm3, share);
  // Pressure by the trapezoidal rule, exact for a density that is linear in between.
  return {depth_m,
          mix(a.temperature_C, b.temperature_C, share),
          mix(a.salinity_psu, b.salinity_psu, share),
          mix(a.sound_speed_mps, b.sound_speed_mps, share),
          density,
          a.pressure_Pa + gravity_mps2_ * (depth_m - a.depth_m) * (a.density_kgpm3 + density) / 2};
}

double WaterColumn::density_kgpm3(double depth_m) const {
  return same_density_ ? config_.density_kgpm3 : row_at(depth_m).density_kgpm3;
}

double WaterColumn::pressure_Pa(double depth_m) const {
  if (!(depth_m > 0)) return 0;
  if (same_density_) return config_.density_kgpm3 * gravity_mps2_ * depth_m;
  const Row& last = rows_.back();
  if (depth_m <= last.depth_m) return row_at(depth_m).pressure_Pa;
  return last.pressure_Pa + last.density_kgpm3 * gravity_mps2_ * (depth_m - last.depth_m);
}

double WaterColumn::sound_speed_mps(double depth_m) const {
  if (config_.sound_speed_mps) return *config_.sound_speed_mps;
  const Row row = row_at(depth_m);
  if (row.sound_speed_mps > 0) return row.sound_speed_mps;
  const double T = row.temperature_C, S = row.salinity_psu, depth = std::max(0.0, depth_m);
  switch (config_.sound) {
    case WaterConfig::SoundSpeed::medwin:
      return medwin_mps(T, S, depth);
    case WaterConfig::SoundSpeed::unesco:
      return chen_millero_mps(T, S, pressure_Pa(depth) / dbar_Pa);
    default:
      return mackenzie_mps(T, S, depth);
  }
}

double WaterColumn::mean_slowness_spm(double depth_m, double other_depth_m) const {
  const double high_m = std::min(depth_m, other_depth_m), low_m = std::max(depth_m, other_depth_m);
  // Over less than a millimeter the value in the middle is exact to rounding.
  if (config_.sound_speed_mps || low_m - high_m < 1e-3) return 1 / sound_speed_mps((high_m + low_m) / 2);
  // Gauss-Legendre quadrature with 3 points per interval: its error is 5 digits below the variation of the speed in 20
  // m.
  constexpr double point = 0.7745966692414834;  // sqrt(3 / 5)
  double time_s = 0, from_m = high_m;
  const auto add_to = [&](double to_m) {
    const double half_m = (to_m - from_m) / 2, middle_m = from_m + half_m;
    time_s += half_m / 9 *
              (5 / sound_speed_mps(middle_m - point * half_m) + 8 / sound_speed_mps(middle_m) +
               5 / sound_speed_mps(middle_m + point * half_m));
    from_m = to_m;
  };
  for (auto row = std::upper_bound(rows_.begin(), rows_.end(), high_m,
                                   [](double depth, const Row&each) { return depth < each.depth_m; });
       row != rows_.end() && row->depth_m < low_m; ++row)
    add_to(row->depth_m);
  // Below the last row only the pressure changes.
  const int pieces = std::max(1, static_cast<int>(std::ceil((low_m - from_m) / 1000)));
  const double piece_m = (low_m - from_m) / pieces;
  for (int i = 1; i <= pieces; ++i) add_to(i == pieces ? low_m : from_m + piece_m);
  return time_s / (low_m - high_m);
}

namespace {

// Margin for well-mixed water: adiabatic warming of at most 0.15 K per km and an expansion of 2e-4 per K give 3e-5
// kg/m^3 per m.
constexpr double mixed_kgpm4 = 5e-5;

}  // namespace

std::optional<double> unstable_at_m(const WaterConfig& water, const WaterColumn& column) {
  for (std::size_t i = 1; i < water.profile.size(); ++i) {
    const WaterLayerConfig &above = water.profile[i - 1], &here = water.profile[i];
    double lighter_kgpm3 = above.density_kgpm3.value_or(0) - here.density_kgpm3.value_or(0);
    if (water.density == WaterConfig::Density::eos80) {
      // Both are compared at the same pressure: compression alone makes deep water denser, and does not make it
      // stable.
      const double p_dbar = column.pressure_Pa(here.depth_m) / dbar_Pa;
      lighter_kgpm3 = eos80_kgpm3(above.temperature_C, above.salinity_psu, p_dbar) -
                      eos80_kgpm3(here.temperature_C, here.salinity_psu, p_dbar) -
                      mixed_kgpm4 * (here.depth_m - above.depth_m);
    }
    if (lighter_kgpm3 > 0) return here.depth_m;
  }
  return {};
}

}  // namespace sim
