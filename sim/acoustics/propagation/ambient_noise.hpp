// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/acoustics/propagation/decibels.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Ambient noise of the sea from turbulence, shipping, wind and thermal noise: the curves of Wenz (JASA 34, 1962) in
/// the form of R. Coates (Underwater Acoustic Systems, 1990), as in M. Stojanovic (On the relationship between capacity
/// and distance in an underwater acoustic communication channel, 2007).
struct AmbientNoise {
  double shipping = 0.5;  ///< 0 (none near) to 1 (heavy)
  double wind_mps = 5;
  Decibels offset;  ///< added to the whole spectrum, such as for a harbour

  /// Spectral level, dB re 1 uPa^2/Hz.  frequency_kHz > 0.
  Decibels spectral_level(double frequency_kHz) const;
  /// Level in the band about the center, dB re 1 uPa: integral of the spectrum.  The band is cut at 1 Hz.
  Decibels band_level(double centre_Hz, double bandwidth_Hz) const;
};

/// `noise:` of a world's acoustics.
struct NoiseConfig {
  double shipping = 0.5;
  std::optional<double> wind_mps;  ///< unset: the wind of the medium
  double offset_dB = 0;
  void read(ParamReader& in);

  AmbientNoise with_wind(double medium_wind_mps) const {
    return {shipping, wind_mps.value_or(medium_wind_mps), Decibels(offset_dB)};
  }
};

}  // namespace sim
