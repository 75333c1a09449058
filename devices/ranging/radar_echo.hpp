// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/config/param_reader.hpp"
#include "sim/medium/medium.hpp"
#include "sim/random/random.hpp"

namespace devices {

/// Transmitter, antenna and receiver of a radar; read from the map of the device.
struct RadarParams {
  enum class Polarization { horizontal, vertical };

  double frequency_GHz = 9.41;
  double peak_power_W = 4000;
  double pulse_s = 8e-8;
  double horizontal_rad = sim::degrees_to_radians(4);
  double vertical_rad = sim::degrees_to_radians(25);
  Polarization polarization = Polarization::horizontal;
  double losses_dB = 3;
  double noise_figure_dB = 6;
  void read(sim::ParamReader& in);

  /// Returns the range resolution, half the length of a pulse, m.
  double pulse_m() const;
  /// Returns the gain on the axis of the beam by its widths: 26000 over the product of both in degrees (Stutzman and
  /// Thiele, Antenna Theory and Design, 3rd ed., 2013, eq. 9-55: antennas with losses and side lobes).
  double gain() const;
  /// Returns K of the radar equation P = K sigma / r^4 on the axis of the beam, with P in mW (Skolnik, Radar Handbook,
  /// 3rd ed., 2008, ch. 1): K = P_t G^2 lambda^2 / ((4 pi)^3 L).
  double echo_constant_mWm2() const;
  /// Returns the noise of the receiver k T B F, with T = 290 K and a band B of 1 / pulse_s, mW.
  double noise_mW() const;
};

/// Returns the mean radar cross section of a square meter of sea by the model of the Naval Research Laboratory
/// (Gregers-Hansen and Mital, An improved empirical model for radar sea clutter reflectivity, NRL/MR/5310-12-9346,
/// 2012), for 0.5 to 35 GHz, sea states 0 to 6 and grazing angles from 0.1 to 60 degrees; smaller ones are
/// extrapolated, larger ones are 60 degrees.  0 when `grazing_rad` is not positive.
double sea_reflectivity(double grazing_rad, double frequency_GHz, double sea_state, RadarParams::Polarization kind);

/// Returns the sea state of a run, 0 to 6: that of its significant wave height, of which `sea_state` of its waves is
/// the inverse; without waves that of a sea that its mean wind has raised (wind = 3.16 m/s s^0.8: Horst, Dyer and
/// Tuley, Radar sea clutter model, URSI 1978).
double sea_state_of(const sim::Medium& medium);

/// Returns the power that a square-law detector receives from a steady echo in complex Gaussian interference of a mean
/// power: its mean is the sum of both.
double detected_mW(double steady_mW, double interference_mW, sim::Random& random);

/// Returns a random local mean with mean 1 of the K distribution: a gamma variate of this shape (Ward, Compound
/// representation of high resolution sea clutter, Electronics Letters 17, 1981), by the method of Marsaglia and Tsang
/// (ACM Trans. Math. Software 26, 2000).
double clutter_texture(double shape, sim::Random& random);

}  // namespace devices
