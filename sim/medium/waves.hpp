// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/medium/medium_config.hpp"
#include "sim/medium/wave_spectrum.hpp"

namespace sim {

/// Effect of waves at a point.
struct WaveMotion {
  double elevation_m = 0;                      ///< of the surface above the still surface
  double head_m = 0;                           ///< dynamic pressure over density and gravity
  Vector3d velocity_W = Vector3d::Zero();      ///< m/s
  Vector3d acceleration_W = Vector3d::Zero();  ///< m/s^2
};

/// Sea by linear (Airy) wave theory: the sum of its harmonic waves.
///
/// The motion decays with the depth below the instantaneous surface (Wheeler stretching, 1970): at the surface the
/// water moves as linear theory gives for the still surface, in crests and in troughs, and the pressure there is that
/// of the air.
class Waves {
 public:
  /// Makes the waves.  Throws ConfigError for breaking waves.
  Waves(const WavesConfig& config, double gravity_mps2, std::uint64_t seed);

  void advance_to(Time now);
  double elevation_m(double x_m, double y_m) const;
  double elevation_m(double x_m, double y_m, Time at) const;
  /// Motion at a point.  `z_m`: above the still surface; points above the water have the motion at the surface.
  WaveMotion at(double x_m, double y_m, double z_m) const;
  const std::vector<WaveComponent>& components() const { return components_; }
  /// Upper bound of the elevation.
  double highest_m() const { return highest_m_; }

 private:
  using Column = std::vector<double>;

  void set_turns(Time at, Column& turns) const;
  double elevation_of(double x_m, double y_m, const Column& turns) const;

  std::vector<WaveComponent> components_;
  double depth_m_;  ///< infinite: deep
  double highest_m_ = 0;
  // Arrays with one number per wave, padded with waves of zero height to whole lanes.  Angles in turns.
  Column kx_, ky_, turns_, k_, amplitude_;
  Column speed_, speed_x_, speed_y_;                       ///< amplitude omega, and its horizontal components, m/s
  Column acceleration_, acceleration_x_, acceleration_y_;  ///< amplitude omega^2
  Column two_k_depth_, by_sinh_, by_cosh_;                 ///< finite depth: 2 k h, 1 / (1 -+ e^(-2 k h))
};

}  // namespace sim
