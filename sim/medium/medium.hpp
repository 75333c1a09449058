// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/medium/current.hpp"
#include "sim/medium/medium_config.hpp"
#include "sim/medium/water_column.hpp"
#include "sim/medium/waves.hpp"
#include "sim/medium/wind.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Water properties at a point, at the time of the medium.
struct LocalWater {
  double surface_m = 0;                        ///< height of the surface at this position, including waves and tide
  double density_kgpm3 = 0;                    ///< of the water; 0 in a world without water
  Vector3d velocity_W = Vector3d::Zero();      ///< current and waves, m/s
  Vector3d acceleration_W = Vector3d::Zero();  ///< of the water in waves, m/s^2; without that of a current
  void visit_state(StateArchive& archive) {
    archive.not_only_finite(surface_m);  // -infinity: no water
    archive(density_kgpm3, velocity_W, acceleration_W);
  }
};

/// Medium around the bodies of a world: water below the surface, air above it.  World frame, east-north-up.
/// docs/models/medium.md has the models and their sources.
///
/// Time advances by advance_to() only; all results are for that time, and do not depend on previous calls.  Points
/// outside the water (above the surface, or in a world without water) have valid results: those of the air, and
/// LocalWater as at the surface.
class Medium {
 public:
  /// Makes the medium.  Throws ConfigError (files, breaking waves).  Warns of an unstable density profile.
  Medium(const MediumConfig& config, double gravity_mps2, std::uint64_t seed);

  bool has_water() const { return config_.water.has_value(); }
  bool has_waves() const { return waves_.has_value(); }

  /// Advances to a time, which must not decrease.
  void advance_to(Time now);
  Time now() const { return now_; }

  /// Height of the surface in the world; minus infinity in a world without water.
  double surface_m(double x_m, double y_m) const;
  /// The same at a given time.
  double surface_m(double x_m, double y_m, Time at) const;
  /// Height of the surface without waves; minus infinity in a world without water.
  double still_surface_m() const { return still_m_; }
  /// Waves of the run, sorted by wave number; empty: none.
  std::span<const WaveComponent> wave_components() const;
  /// Upper bound of the surface height at this time.
  double highest_surface_m() const { return still_m_ + (waves_ ? waves_->highest_m() : 0); }
  /// Depth below the instantaneous surface, m; negative in the air, minus infinity in a world without water.
  double depth_m(const Vector3d& p_W) const { return surface_m(p_W.x(), p_W.y()) - p_W.z(); }
  bool in_water(const Vector3d& p_W) const { return depth_m(p_W) > 0; }
  /// All water properties at once; cheaper than the separate functions below.
  LocalWater water_at(const Vector3d& p_W) const;
  /// Velocity of the water (current and waves), m/s.
  Vector3d water_velocity_W(const Vector3d& p_W) const;
  /// Whether all gridded currents contain the point.
  bool current_known(const Vector3d& p_W) const { return !current_ || current_->known(p_W.x(), p_W.y()); }
  /// Current; null in a world without water.
  const Current* current() const { return current_ ? &*current_ : nullptr; }
  /// Velocity of the wind, m/s.  Below the surface: as at the surface.
  Vector3d air_velocity_W(const Vector3d& p_W) const;
  /// Horizontal mean wind speed at the reference height, without gusts; 0 without wind.
  double mean_wind_mps() const;
  /// Density of water or air, kg/m^3.
  double density_kgpm3(const Vector3d& p_W) const;
  /// Absolute pressure in water or air, Pa, including the dynamic pressure of waves.
  double pressure_Pa(const Vector3d& p_W) const;
  /// Temperature and salinity of the water at this depth; above the surface, those at the surface.
  double temperature_C(const Vector3d& p_W) const;
  double salinity_psu(const Vector3d& p_W) const;
  /// Speed of sound in water or air, m/s.
  double sound_speed_mps(const Vector3d& p_W) const;
  /// Mean slowness, 1 / sound speed, between two heights, s/m: of the water, with the value at the still surface above
  /// it; of the air in a world without water.
  double mean_slowness_spm(double z_m, double other_z_m) const;
  /// Speed of sound at a depth below the still surface, m/s; above it, that at the surface.  Only in water.
  double sound_speed_at_depth_mps(double depth_m) const { return column_->sound_speed_mps(depth_m); }
  /// Depths between which the properties of the water vary smoothly: those of the rows of a profile.
  std::vector<double> profile_depths_m() const;
  /// Whether a profile sets the speed of sound.
  bool has_sound_profile() const;

  void visit_state(StateArchive& archive);

 private:
  MediumConfig config_;
  double gravity_mps2_;
  std::optional<WaterColumn> column_;  ///< column_ and current_: in a world with water
  std::optional<Current> current_;
  std::optional<Waves> waves_;
  std::optional<Wind> wind_;
  double still_m_;  ///< present height of the surface without waves
  Time now_{0};
};

}  // namespace sim
