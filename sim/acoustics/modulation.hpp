// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/acoustics/decibels.hpp"

namespace sim {

/// How bits are put on a sound.  fsk: binary, detected without phase; psk: binary, coherent; dpsk: binary,
/// differential.
enum class Modulation { fsk, psk, dpsk };

/// Energy per bit over noise per hertz, from the power ratio in the band.
PowerRatio energy_per_bit(PowerRatio snr, double bandwidth_Hz, double bit_rate_bps);

/// Of a bit in white noise (J. G. Proakis, Digital Communications, 4th ed., 2001, chapter 5); 0.5 without any signal.
double bit_error_probability(Modulation modulation, PowerRatio EbN0);
/// Of fsk when the power fades as Rayleigh's amplitude does, from bit to bit, about this mean (Proakis, chapter 14).
double bit_error_rayleigh_fsk(PowerRatio mean_EbN0);

/// That none of `bits` independent bits is wrong; also of 1e5 bits and bit errors of 1e-12. `coding_gain_dB`: coding
/// gain on Eb/N0.
double packet_success_probability(Modulation modulation, PowerRatio EbN0, std::int64_t bits,
                                  Decibels coding_gain = Decibels(0));
double packet_success_probability(double bit_error, std::int64_t bits);

/// Of `bits` at this rate, s.
double packet_duration_s(std::int64_t bits, double bit_rate_bps);

const char* to_string(Modulation modulation);

}  // namespace sim
