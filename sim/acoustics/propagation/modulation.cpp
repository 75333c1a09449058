// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/modulation.hpp"

#include <cmath>

namespace sim {

PowerRatio energy_per_bit(PowerRatio snr, double bandwidth_Hz, double bit_rate_bps) {
  return bandwidth_Hz / bit_rate_bps * snr;
}

double bit_error_probability(Modulation modulation, PowerRatio EbN0) {
  const double g = EbN0.linear();
  switch (modulation) {
    case Modulation::fsk:
      return 0.5 * std::exp(-g / 2);
    case Modulation::psk:
      return 0.5 * std::erfc(std::sqrt(g));
    case Modulation::dpsk:
      break;
  }
  return 0.5 * std::exp(-g);
}

double bit_error_rayleigh_fsk(PowerRatio mean_EbN0) {
  return 1 / (2 + mean_EbN0.linear());
}

double packet_success_probability(double bit_error, std::int64_t bits) {
  return std::exp(static_cast<double>(bits) * std::log1p(-bit_error));
}

double packet_success_probability(Modulation modulation, PowerRatio EbN0, std::int64_t bits, Decibels coding_gain) {
  return packet_success_probability(bit_error_probability(modulation, EbN0 * to_power(coding_gain)), bits);
}

double packet_duration_s(std::int64_t bits, double bit_rate_bps) {
  return static_cast<double>(bits) / bit_rate_bps;
}

const char* to_string(Modulation modulation) {
  switch (modulation) {
    case Modulation::fsk:
      return "fsk";
    case Modulation::psk:
      return "psk";
    case Modulation::dpsk:
      break;
  }
  return "dpsk";
}

}  // namespace sim
