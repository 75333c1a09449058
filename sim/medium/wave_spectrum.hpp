// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/medium/medium_config.hpp"
#include "sim/random/random.hpp"

namespace sim {

/// Harmonic wave: elevation = amplitude cos(k (x cos(direction) + y sin(direction)) - omega t + phase).
struct WaveComponent {
  double omega_radps = 0;
  double k_radpm = 0;
  double amplitude_m = 0;
  double direction_rad = 0;  ///< of propagation, counter-clockwise from east
  double phase_rad = 0;
};

/// Spectral density of the elevation, m^2 s/rad, after Pierson and Moskowitz in the form of Bretschneider:
/// S = 5/16 Hs^2 wp^4 w^-5 exp(-1.25 (wp/w)^4).
double pierson_moskowitz_m2s(double omega_radps, double hs_m, double tp_s);
/// JONSWAP spectrum (Hasselmann et al. 1973; DNV-RP-C205, 3.5.5): (1 - 0.287 ln g) times the above times g^exp(-((w -
/// wp) / (s wp))^2 / 2), with s = 0.07 up to wp and 0.09 above it.
double jonswap_m2s(double omega_radps, double hs_m, double tp_s, double gamma);

/// Wave number k from the dispersion relation omega^2 = g k tanh(k depth), rad/m, to rounding.  The depth may be
/// infinite.
double wave_number(double omega_radps, double gravity_mps2, double depth_m);

/// Returns the waves of a sea, sorted by wave number.  A regular sea has one.  For an irregular sea, the band from 0.3
/// to `cutoff` times the peak frequency is divided into bins with equal shares of the mean of variance and mean square
/// vertical speed, so that both the peak and short waves are well resolved; each bin gives one wave with the energy of
/// the bin, at a random frequency in it (the sea does not repeat).  The sum of the variances is Hs^2 / 16 to rounding.
/// Phases are uniform; with spreading each wave draws its own direction.
std::vector<WaveComponent> make_waves(const WavesConfig& config, double gravity_mps2, Random& random);

}  // namespace sim
