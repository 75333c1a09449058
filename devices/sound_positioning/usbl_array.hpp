// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/acoustics/propagation/decibels.hpp"
#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace devices {

/// Tone that a USBL receives.
struct UsblTone {
  sim::PowerRatio snr;        ///< signal over noise and other sounds, in the band of the tone
  double time_bandwidth = 1;  ///< length times bandwidth, at least 1
  double wavelength_m = 0.05;
};

/// `array:` of a USBL: hydrophones in the xy-plane of the sensor, a pair along x and one along y.  Each pair measures
/// the cosine of the angle between the sound and its axis by a difference of phase.
struct UsblArrayParams {
  double baseline_m = 0.1;   ///< between the hydrophones of a pair
  double phase_std_rad = 0;  ///< error of each difference at any level
  void read(sim::ParamReader& in);
  /// Returns the standard deviation of each of both cosines: wavelength / (2 pi baseline) times that of the difference
  /// of phase, whose variance is (1 + 2 SNR) / (2 SNR^2 time_bandwidth) (Quazi, IEEE Trans. ASSP 29, 1981, for a band
  /// that is narrow to its frequency), and that of `phase_std_rad`.
  double cosine_std(const UsblTone& tone) const;
};

/// Adds errors to both cosines that an array measures, those of the direction with x and y.  The third follows from
/// them; its sign is known.
sim::Vector3d with_cosine_errors(const sim::Vector3d& direction_S, double error_x, double error_y);

/// Turns a direction by two small angles: up, towards z, and across, to the left of the direction seen from z.
sim::Vector3d turned(double azimuth_rad, double elevation_rad, double across_rad, double up_rad);

}  // namespace devices
