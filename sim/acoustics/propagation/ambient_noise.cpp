// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/ambient_noise.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

Decibels AmbientNoise::spectral_level(double frequency_kHz) const {
  const double log_f = std::log10(frequency_kHz);
  const Decibels turbulence(17 - 30 * log_f);
  const Decibels ships(40 + 20 * (shipping - 0.5) + 26 * log_f - 60 * std::log10(frequency_kHz + 0.03));
  const Decibels waves(50 + 7.5 * std::sqrt(wind_mps) + 20 * log_f - 40 * std::log10(frequency_kHz + 0.4));
  const Decibels heat(-15 + 20 * log_f);
  return to_decibels(to_power(turbulence) + to_power(ships) + to_power(waves) + to_power(heat)) + offset;
}

Decibels AmbientNoise::band_level(double centre_Hz, double bandwidth_Hz) const {
  // Gauss-Legendre quadrature with 4 points on intervals that grow by at most a third of their lower end; as the
  // spectrum falls by powers of the frequency, the error of each interval is below 1e-4 dB.
  constexpr double point[] = {0.3399810435848563, 0.8611363115940526};
  constexpr double weight[] = {0.6521451548625461, 0.3478548451374538};
  double low_Hz = std::max(centre_Hz - bandwidth_Hz / 2, 1.0);
  const double high_Hz = std::max(centre_Hz + bandwidth_Hz / 2, low_Hz);
  PowerRatio sum;
  while (low_Hz < high_Hz) {
    const double end_Hz = std::min(high_Hz, low_Hz * 4 / 3), half_Hz = (end_Hz - low_Hz) / 2;
    for (int i = 0; i < 2; ++i)
      for (const double side : {-1.0, 1.0}) {
        const double f_Hz = low_Hz + half_Hz * (1 + side * point[i]);
        sum += half_Hz * weight[i] * to_power(spectral_level(f_Hz / 1000));
      }
    low_Hz = end_Hz;
  }
  return to_decibels(sum);
}

void NoiseConfig::read(ParamReader& in) {
  in.read("shipping", shipping, between(0, 1), "shipping noise; 0: none; 1: heavy");
  in.read("wind_mps", wind_mps, between(0, 60),
          "wind speed that makes the noise; unset: the mean wind of the medium, at 10 m");
  in.read("offset_dB", offset_dB, between(-200, 200), "added to the whole spectrum");
}

}  // namespace sim
