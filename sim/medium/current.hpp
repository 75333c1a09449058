// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/medium/current_grid.hpp"
#include "sim/medium/gauss_markov.hpp"
#include "sim/medium/medium_config.hpp"

namespace sim {

/// How the water flows without waves: the sum of the entries of `current:` and of the tides.
class Current {
 public:
  /// Throws ConfigError (files).
  Current(const std::vector<CurrentConfig>& entries, const std::vector<TideConfig>& tides, std::uint64_t seed);

  /// Not back in time.
  void advance_to(Time now);
  /// m/s in the world; `depth_m` below the surface, what is above flows as the surface does.
  Vector3d velocity_W(double x_m, double y_m, double depth_m) const {
    return varies_ ? uniform_W_ + local_W(x_m, y_m, depth_m) : uniform_W_;
  }
  /// All grids reach there.
  bool known(double x_m, double y_m) const;
  /// Of the tides over the still surface.
  static double tide_m(const std::vector<TideConfig>& tides, Time at);
  /// After restoring the flow follows at the next advance_to().
  void visit_state(StateArchive& archive) {
    for (Wandering& part : wandering_) archive(part.errors);
  }

 private:
  /// A speed and a direction that wander, as a velocity.
  struct Wandering {
    double speed_mps, direction_rad;
    GaussMarkov errors;  ///< of speed, direction, vertical velocity
  };
  struct Vortex {
    Eigen::Vector2d center_m;
    double peak_speed_mps, core_radius_m;
    CurrentConfig::Core core;
  };

  Vector3d local_W(double x_m, double y_m, double depth_m) const;

  std::vector<TideConfig> tides_;
  Vector3d constant_W_ = Vector3d::Zero();
  std::vector<Wandering> wandering_;
  std::vector<CurrentConfig> by_depth_;
  std::vector<Vortex> vortices_;
  std::vector<CurrentGrid> grids_;
  bool varies_ = false;  ///< with the place
  Vector3d uniform_W_ = Vector3d::Zero();
};

/// Speed at a depth of the tidal profile of DNV-RP-C205: V0 ((H - z) / H)^exponent; 0 at the bottom H and below.
double power_law_speed_mps(double surface_speed_mps, double depth_m, double water_depth_m, double exponent);
/// Speed at a depth of the wind-driven profile of DNV-RP-C205: V0 (d0 - z) / d0; 0 from d0 on.
double wind_driven_speed_mps(double surface_speed_mps, double depth_m, double reference_depth_m);

}  // namespace sim
