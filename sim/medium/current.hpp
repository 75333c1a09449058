// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/medium/current_grid.hpp"
#include "sim/medium/gauss_markov.hpp"
#include "sim/medium/medium_config.hpp"

namespace sim {

/// Current: velocity of the water without waves, the sum of the entries of `current:` and of the tidal currents.
class Current {
 public:
  /// Reads the files of gridded currents.  Throws ConfigError.
  Current(const std::vector<CurrentConfig>& entries, const std::vector<TideConfig>& tides, std::uint64_t seed);

  /// Advances to a time, which must not decrease.
  void advance_to(Time now);
  /// Velocity in the world, m/s.  `depth_m`: below the surface; negative depths have the velocity at the surface.
  Vector3d velocity_W(double x_m, double y_m, double depth_m) const {
    return varies_ ? uniform_W_ + local_W(x_m, y_m, depth_m) : uniform_W_;
  }
  /// Whether all grids contain the point.
  bool known(double x_m, double y_m) const;
  /// Gridded currents, in the order of their entries.
  std::span<const CurrentGrid> grids() const { return grids_; }
  /// Whether a part of the current is random.
  bool is_random() const { return !wandering_.empty(); }
  /// Part that is the same at all places: constant, tidal and random currents.
  const Vector3d& uniform_W() const { return uniform_W_; }
  /// Tidal elevation over the still surface.
  static double tide_m(const std::vector<TideConfig>& tides, Time at);
  /// Visits the state; velocities are updated by the next advance_to().
  void visit_state(StateArchive& archive) {
    for (Wandering& part : wandering_) archive(part.errors);
  }

 private:
  /// Current whose speed and direction are Gauss-Markov processes.
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
  bool varies_ = false;  ///< in space
  Vector3d uniform_W_ = Vector3d::Zero();
};

/// Speed at a depth for the tidal profile of DNV-RP-C205: V0 ((H - z) / H)^exponent; 0 at the bottom H and below.
double power_law_speed_mps(double surface_speed_mps, double depth_m, double water_depth_m, double exponent);
/// Speed at a depth for the wind-driven profile of DNV-RP-C205: V0 (d0 - z) / d0; 0 from d0 on.
double wind_driven_speed_mps(double surface_speed_mps, double depth_m, double reference_depth_m);

}  // namespace sim
