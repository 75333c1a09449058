// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/medium/medium_config.hpp"

namespace sim {

/// A decibar in Pa: oceanography gives pressure in it.
inline constexpr double dbar_Pa = 1e4;

/// The water by depth, in m below the surface; above it as at the surface.
class WaterColumn {
 public:
  WaterColumn(const WaterConfig& config, double gravity_mps2);

  double density_kgpm3(double depth_m) const;
  /// Over that of the atmosphere: the weight of the water above.
  double pressure_Pa(double depth_m) const;
  double temperature_C(double depth_m) const { return row_at(depth_m).temperature_C; }
  double salinity_psu(double depth_m) const { return row_at(depth_m).salinity_psu; }
  double sound_speed_mps(double depth_m) const;
  /// Mean of 1 / sound speed over the depths between two, s/m.  Exact to rounding: the water is smooth between rows.
  double mean_slowness_spm(double depth_m, double other_depth_m) const;

 private:
  struct Row {
    double depth_m, temperature_C, salinity_psu, sound_speed_mps, density_kgpm3, pressure_Pa;
  };

  /// Pressures, and densities where they come from an equation of state.
  void integrate();
  /// All but the pressure is linear between rows; above the first and below the last as there.
  Row row_at(double depth_m) const;

  WaterConfig config_;
  double gravity_mps2_;
  bool same_density_;
  std::vector<Row> rows_;  ///< one at least, the first at the surface
};

}  // namespace sim
