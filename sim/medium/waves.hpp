// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/medium/medium_config.hpp"
#include "sim/medium/wave_spectrum.hpp"

namespace sim {

/// What waves do at a place.
struct WaveMotion {
  double elevation_m = 0;                      ///< of the surface over the still one
  double head_m = 0;                           ///< dynamic pressure by density and gravity
  Vector3d velocity_W = Vector3d::Zero();      ///< m/s
  Vector3d acceleration_W = Vector3d::Zero();  ///< m/s^2
};

/// A sea by linear (Airy) theory: the sum of its harmonic waves.
///
/// Motion under the surface decays with the depth below the momentary surface (Wheeler 1970): at the surface the waves
/// move the water as linear theory says for the still one, in crests and in troughs, and the pressure there is that of
/// the air.
class Waves {
 public:
  /// Throws ConfigError: waves that would break.
  Waves(const WavesConfig& config, double gravity_mps2, std::uint64_t seed);

  void advance_to(Time now);
  double elevation_m(double x_m, double y_m) const;
  double elevation_m(double x_m, double y_m, Time at) const;
  /// `z_m` over the still surface; places over the water: as at the surface.
  WaveMotion at(double x_m, double y_m, double z_m) const;
  const std::vector<WaveComponent>& components() const { return components_; }
  /// No crest is higher over the still surface.
  double highest_m() const { return highest_m_; }

 private:
  using Column = std::vector<double>;

  void set_turns(Time at, Column& turns) const;
  double elevation_of(double x_m, double y_m, const Column& turns) const;

  std::vector<WaveComponent> components_;
  double depth_m_;  ///< infinite: deep
  double highest_m_ = 0;
  // One number a wave, filled up with waves of no height to whole lanes.  Angles in turns.
  Column kx_, ky_, turns_, k_, amplitude_;
  Column speed_, speed_x_, speed_y_;                       ///< amplitude omega, and its parts, m/s
  Column acceleration_, acceleration_x_, acceleration_y_;  ///< amplitude omega^2
  Column two_k_depth_, by_sinh_, by_cosh_;                 ///< finite depth: 2 k h, 1 / (1 -+ e^(-2 k h))
};

}  // namespace sim
