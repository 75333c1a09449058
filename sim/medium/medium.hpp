// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/medium/current.hpp"
#include "sim/medium/medium_config.hpp"
#include "sim/medium/water_column.hpp"
#include "sim/medium/waves.hpp"
#include "sim/medium/wind.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// The water at a place, at the time of the medium.
struct LocalWater {
  double surface_m = 0;                        ///< height of the surface over the place, waves and tide included
  double density_kgpm3 = 0;                    ///< of the water; 0 in a world without
  Vector3d velocity_W = Vector3d::Zero();      ///< current and waves, m/s
  Vector3d acceleration_W = Vector3d::Zero();  ///< of the water in waves, m/s^2; a current's is left out
  void visit_state(StateArchive& archive) {
    archive.not_only_finite(surface_m);  // -infinity: there is no water
    archive(density_kgpm3, velocity_W, acceleration_W);
  }
};

/// What surrounds the bodies of a world: water below the surface, air over it.  World frame, east-north-up.  The models
/// and their sources are in docs/models/medium.md.
///
/// Time advances by advance_to() only; all results are for that time, and do not depend on previous calls.
/// Places beyond the water (over the surface, or in a world without water) have answers too: those of the air, and
/// LocalWater as at the surface.
class Medium {
 public:
  /// Throws ConfigError (files, waves that break).  Warns of water that is lighter below than above.
  Medium(const MediumConfig& config, double gravity_mps2, std::uint64_t seed);

  bool has_water() const { return config_.water.has_value(); }
  bool has_waves() const { return waves_.has_value(); }

  /// Not back in time.
  void advance_to(Time now);
  Time now() const { return now_; }

  /// Height of the surface in the world; minus infinity in a world without water.
  double surface_m(double x_m, double y_m) const;
  /// The same at any time.
  double surface_m(double x_m, double y_m, Time at) const;
  /// The surface is nowhere higher now.
  double highest_surface_m() const { return still_m_ + (waves_ ? waves_->highest_m() : 0); }
  /// Below the momentary surface, m; negative in the air, minus infinity in a world without water.
  double depth_m(const Vector3d& p_W) const { return surface_m(p_W.x(), p_W.y()) - p_W.z(); }
  bool in_water(const Vector3d& p_W) const { return depth_m(p_W) > 0; }
  /// All of the water in one pass: cheaper than the questions below one by one.
  LocalWater water_at(const Vector3d& p_W) const;
  /// Of the water (current and waves), m/s.
  Vector3d water_velocity_W(const Vector3d& p_W) const;
  /// False where a gridded current ends.
  bool current_known(const Vector3d& p_W) const { return !current_ || current_->known(p_W.x(), p_W.y()); }
  /// Of the wind, m/s.  Below the surface: as at the surface.
  Vector3d air_velocity_W(const Vector3d& p_W) const;
  /// Of the wind, without gusts, at its reference height, level; 0 without wind.
  double mean_wind_mps() const { return config_.wind ? config_.wind->mean_mps().head<2>().norm() : 0; }
  /// Of water or air, kg/m^3.
  double density_kgpm3(const Vector3d& p_W) const;
  /// Absolute, of water or air, Pa; in waves with their dynamic pressure.
  double pressure_Pa(const Vector3d& p_W) const;
  /// Of the water at this depth, also for places over the surface.
  double temperature_C(const Vector3d& p_W) const;
  double salinity_psu(const Vector3d& p_W) const;
  /// In water or air, m/s.
  double sound_speed_mps(const Vector3d& p_W) const;
  /// Mean of 1 / sound speed over the heights between two, s/m: of the water below the still surface, above it as at
  /// the surface; of the air in a world without water.
  double mean_slowness_spm(double z_m, double other_z_m) const;

  void visit_state(StateArchive& archive);

 private:
  MediumConfig config_;
  double gravity_mps2_;
  std::optional<WaterColumn> column_;  ///< these two in a world with water
  std::optional<Current> current_;
  std::optional<Waves> waves_;
  std::optional<Wind> wind_;
  double still_m_;  ///< height of the surface without waves, now
  Time now_{0};
};

}  // namespace sim
