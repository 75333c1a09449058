// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/stability.hpp"

#include "sim/medium/sea_water.hpp"

namespace sim {

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
