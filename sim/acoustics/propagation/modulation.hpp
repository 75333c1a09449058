// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/acoustics/propagation/decibels.hpp"

namespace sim {

/// Modulation of a signal.  fsk: binary, non-coherent; psk: binary, coherent; dpsk: binary, differential.
enum class Modulation { fsk, psk, dpsk };

/// Eb/N0, energy per bit over noise spectral density, from the power ratio in the band.
PowerRatio energy_per_bit(PowerRatio snr, double bandwidth_Hz, double bit_rate_bps);

/// Bit error probability in white noise (J. G. Proakis, Digital Communications, 4th ed., 2001, chapter 5); 0.5 without
/// a signal.
double bit_error_probability(Modulation modulation, PowerRatio EbN0);
/// Bit error probability of fsk with Rayleigh fading that is independent from bit to bit, about this mean (Proakis,
/// chapter 14).
double bit_error_rayleigh_fsk(PowerRatio mean_EbN0);

/// Probability that none of `bits` independent bits is wrong; accurate also for 1e5 bits and bit error probabilities of
/// 1e-12.  `coding_gain`: added to Eb/N0.
double packet_success_probability(Modulation modulation, PowerRatio EbN0, std::int64_t bits,
                                  Decibels coding_gain = Decibels(0));
/// The same from the bit error probability.
double packet_success_probability(double bit_error, std::int64_t bits);

/// Duration of `bits` at this rate, s.
double packet_duration_s(std::int64_t bits, double bit_rate_bps);

const char* to_string(Modulation modulation);

}  // namespace sim
