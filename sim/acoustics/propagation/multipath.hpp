// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "sim/acoustics/propagation/decibels.hpp"
#include "sim/acoustics/propagation/transmission_loss.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/random/random.hpp"

namespace sim {

/// Straight path from an image of the source, mirrored at surface and bottom (image method; F. B. Jensen et al.,
/// Computational Ocean Acoustics, 2nd ed., 2011, chapter 2).
struct ImagePath {
  double length_m = 0;
  int surface_bounces = 0, bottom_bounces = 0;
  double grazing_rad = 0;       ///< grazing angle at each bounce
  bool leaves_upwards = false;  ///< at the source; for the direct path: the receiver is higher
};

/// Computes all paths of up to `max_bounces` between two points in water of constant depth, sorted by length; the
/// direct path is the first.  Depths are below the surface, source and receiver between surface and bottom; an infinite
/// water depth has no bottom.  Replaces the content of `out`.
void image_paths(double source_depth_m, double receiver_depth_m, double horizontal_m, double water_depth_m,
                 int max_bounces, std::vector<ImagePath>& out);

/// `bottom:` of multipath.
struct BottomConfig {
  std::optional<double> loss_dB;  ///< per bounce; unset: from the sediment
  double density_ratio = 1.9;     ///< of sediment over water; the defaults are for sand
  double speed_ratio = 1.1;       ///< of sound in sediment over water
  double attenuation_dB_per_wavelength = 0.8;
  void read(ParamReader& in);
};

/// `multipath:` of a world's acoustics.
struct MultipathConfig {
  enum class Phases { random, geometric };

  int max_bounces = 3;
  double window_s = 0.005;                    ///< arrivals later than this after the first are interference
  std::optional<double> water_depth_m;        ///< unset: from the terrain
  std::optional<double> surface_loss_dB;      ///< per bounce; unset: from the roughness
  std::optional<double> surface_roughness_m;  ///< rms height; unset: from the wind
  BottomConfig bottom;
  Phases phases = Phases::random;  ///< geometric: from the path lengths; valid only for a tone and a flat sea
  void read(ParamReader& in);
};

/// RMS wave height of a fully developed sea under this wind: a quarter of Pierson and Moskowitz's significant wave
/// height, 0.21 U^2 / g (JGR 69, 1964).
double wind_sea_roughness_m(double wind_mps);

/// Coherent pressure reflection coefficient of a rough surface: -exp(-2 (k sigma sin a)^2) (Jensen et al., chapter 1).
double surface_reflection(double wave_number_pm, double roughness_m, double grazing_rad);

/// Rayleigh's pressure reflection coefficient of a fluid bottom (Jensen et al., chapter 1).
std::complex<double> bottom_reflection(const BottomConfig& bottom, double grazing_rad);

/// Properties of the medium along the paths, for path_gains().
struct MultipathMedium {
  double frequency_Hz = 25000;
  double sound_speed_mps = 1500;
  double absorption_dBpkm = 0;
  double wind_mps = 5;
  SpreadingConfig spreading;
};

/// Arrival of one path at the receiver.
struct PathGain {
  double delay_s = 0;    ///< travel time
  Decibels gain;         ///< relative to 1 m from the source: spreading, absorption, bounces
  double phase_rad = 0;  ///< of the pressure: from path length and bounces
};

/// Computes the gains of the paths, in their order.  Replaces the content of `out`.
void path_gains(const std::vector<ImagePath>& paths, const MultipathConfig& config, const MultipathMedium& medium,
                std::vector<PathGain>& out);
/// Draws a phase for each path except the first.
void randomize_phases(std::vector<PathGain>& gains, Random& random);

/// Sum of the paths, relative to the level at 1 m from the source.
struct MultipathSum {
  PowerRatio signal;        ///< inside the window after the first arrival: coherent sum
  PowerRatio interference;  ///< later arrivals: incoherent sum
  double first_s = 0;       ///< travel time of the first path
  double spread_s = 0;      ///< rms of the delays, weighted by power
};

/// Combines the paths.  Zero power without paths.
MultipathSum combine(const std::vector<PathGain>& gains, double window_s);

/// Geometry of a link in water of constant depth.
struct LinkDepths {
  double source_m = 0, receiver_m = 0;  ///< below the surface
  double horizontal_m = 0;
  double water_m = 0;  ///< infinite: no bottom
};

/// Effect of the echoes: powers relative to that of the direct path.
struct Echoes {
  PowerRatio signal{1};  ///< sum inside the window, including the direct path
  PowerRatio late{0};    ///< interference: echoes after the window
  double spread_s = 0;   ///< rms of the delays
  double later_s = 0;    ///< delay of the first arrival relative to the direct path, where that is blocked
};

/// Computes the echoes of a link.  Depths are limited to those between surface and bottom.  `random`: draws the phases
/// for `phases: random`; null: powers add, which is their mean over all phases.  `direct`: gain of the direct path due
/// to an obstacle, minus infinity when it is blocked; powers are relative to the unobstructed direct path.
Echoes echoes(const MultipathConfig& config, const MultipathMedium& medium, const LinkDepths& depths, Random* random,
              Decibels direct = Decibels(0));

}  // namespace sim
