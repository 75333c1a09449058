// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "sim/acoustics/decibels.hpp"
#include "sim/acoustics/transmission_loss.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/random/random.hpp"

namespace sim {

/// A straight path from an image of the source, mirrored at surface and bottom (image method; F. B. Jensen et al.,
/// Computational Ocean Acoustics, 2nd ed., 2011, chapter 2).
struct ImagePath {
  double length_m = 0;
  int surface_bounces = 0, bottom_bounces = 0;
  double grazing_rad = 0;       ///< angle to the level at each bounce
  bool leaves_upwards = false;  ///< at the source; of the direct path: the receiver is higher
};

/// All paths of up to `max_bounces` between two points in water of one depth, by length; the direct one is the first.
/// Depths below the surface, source and receiver between surface and bottom; an infinite water depth has no bottom.
/// Replaces what is in `out`.
void image_paths(double source_depth_m, double receiver_depth_m, double horizontal_m, double water_depth_m,
                 int max_bounces, std::vector<ImagePath>& out);

/// `bottom:` of multipath.
struct BottomConfig {
  std::optional<double> loss_dB;  ///< of each bounce; unset: by the sediment
  double density_ratio = 1.9;     ///< of sediment over water; these are of sand
  double speed_ratio = 1.1;       ///< of sound in sediment over water
  double attenuation_dB_per_wavelength = 0.8;
  void read(ParamReader& in);
};

/// `multipath:` of a world's acoustics.
struct MultipathConfig {
  enum class Phases { random, geometric };

  int max_bounces = 3;
  double window_s = 0.005;                    ///< what comes later than this after the first disturbs
  std::optional<double> water_depth_m;        ///< unset: by the terrain
  std::optional<double> surface_loss_dB;      ///< of each bounce; unset: by the roughness
  std::optional<double> surface_roughness_m;  ///< rms height; unset: by the wind
  BottomConfig bottom;
  Phases phases = Phases::random;  ///< geometric: by the lengths; right for a tone and a flat sea only
  void read(ParamReader& in);
};

/// RMS height of the waves of a sea that has grown under this wind for long: a quarter of Pierson and Moskowitz's
/// significant height, 0.21 U^2 / g (JGR 69, 1964).
double wind_sea_roughness_m(double wind_mps);

/// Pressure of a wave that a rough surface mirrors over that of the wave that comes: -exp(-2 (k sigma sin a)^2), the
/// coherent part (Jensen et al., chapter 1).
double surface_reflection(double wave_number_pm, double roughness_m, double grazing_rad);

/// Rayleigh's reflection coefficient, of the pressure, of a fluid bottom (Jensen et al., chapter 1).
std::complex<double> bottom_reflection(const BottomConfig& bottom, double grazing_rad);

/// What sound has gone through on its way, for path_gains().
struct MultipathMedium {
  double frequency_Hz = 25000;
  double sound_speed_mps = 1500;
  double absorption_dBpkm = 0;
  double wind_mps = 5;
  SpreadingConfig spreading;
};

/// One path at the receiver.
struct PathGain {
  double delay_s = 0;    ///< travel time
  Decibels gain;         ///< over the level at 1 m from the source: spreading, absorption, bounces
  double phase_rad = 0;  ///< of the pressure: by the length and the bounces
};

/// Replaces what is in `out`; in the order of the paths.
void path_gains(const std::vector<ImagePath>& paths, const MultipathConfig& config, const MultipathMedium& medium,
                std::vector<PathGain>& out);
/// Draws a phase for each path but the first.
void randomize_phases(std::vector<PathGain>& gains, Random& random);

/// What the paths give together, over the level at 1 m from the source.
struct MultipathSum {
  PowerRatio signal;        ///< inside the window after the first: pressures add up, with their phases
  PowerRatio interference;  ///< later: powers add up
  double first_s = 0;       ///< travel time of the first path
  double spread_s = 0;      ///< rms of the delays, weighted by power
};

/// Nothing for no paths.
MultipathSum combine(const std::vector<PathGain>& gains, double window_s);

}  // namespace sim
