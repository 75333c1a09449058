// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sim/medium/medium_config.hpp"

namespace sim {

/// One decibar in Pa, the unit of pressure in oceanography.
inline constexpr double dbar_Pa = 1e4;

/// Water properties by depth, in m below the surface; above it as at the surface.
class WaterColumn {
 public:
  WaterColumn(const WaterConfig& config, double gravity_mps2);

  double density_kgpm3(double depth_m) const;
  /// Pressure relative to the atmosphere: the weight of the water above.
  double pressure_Pa(double depth_m) const;
  double temperature_C(double depth_m) const { return row_at(depth_m).temperature_C; }
  double salinity_psu(double depth_m) const { return row_at(depth_m).salinity_psu; }
  double sound_speed_mps(double depth_m) const;
  /// Mean slowness, 1 / sound speed, between two depths, s/m.  Exact to rounding, as the water is smooth between rows.
  double mean_slowness_spm(double depth_m, double other_depth_m) const;

 private:
  struct Row {
    double depth_m, temperature_C, salinity_psu, sound_speed_mps, density_kgpm3, pressure_Pa;
  };

  /// Integrates the pressures, and computes densities from an equation of state.
  void integrate();
  /// Row at a depth: all values except the pressure are linear between rows, and constant beyond the first and last.
  Row row_at(double depth_m) const;

  WaterConfig config_;
  double gravity_mps2_;
  bool same_density_;
  std::vector<Row> rows_;  ///< at least one; the first is at the surface
};

/// Depth (m) of the first row of the profile whose water is lighter than that of the row above it.  With an equation of
/// state, densities are compared at the same pressure, with a margin for well-mixed water.  `column`: of this water.
std::optional<double> unstable_at_m(const WaterConfig& water, const WaterColumn& column);

}  // namespace sim
