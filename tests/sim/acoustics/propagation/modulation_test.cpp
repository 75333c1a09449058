// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/modulation.hpp"

#include <gtest/gtest.h>

#include "tests/fidelity/closed_forms.hpp"

namespace {

using sim::Decibels;
using sim::Modulation;
using sim::PowerRatio;
using test::ClosedForm;

PowerRatio ratio_of(const ClosedForm& form) {
  return sim::to_power(Decibels(form.at("EbN0_dB")));
}

TEST(Modulation, HasTheBitErrorsOfTheReference) {
  for (const ClosedForm& form : test::closed_forms_of("ber_bfsk_noncoherent"))
    test::expect_closed_form(sim::bit_error_probability(Modulation::fsk, ratio_of(form)), form);
  for (const ClosedForm& form : test::closed_forms_of("ber_bpsk_coherent"))
    test::expect_closed_form(sim::bit_error_probability(Modulation::psk, ratio_of(form)), form);
  for (const ClosedForm& form : test::closed_forms_of("ber_dpsk"))
    test::expect_closed_form(sim::bit_error_probability(Modulation::dpsk, ratio_of(form)), form);
  for (const ClosedForm& form : test::closed_forms_of("ber_bfsk_rayleigh"))
    test::expect_closed_form(sim::bit_error_rayleigh_fsk(ratio_of(form)), form);
}

TEST(Modulation, HasThePacketSuccessOfTheReference) {
  for (const ClosedForm& form : test::closed_forms_of("packet_success_bfsk")) {
    const auto bits = static_cast<std::int64_t>(8 * form.at("bytes"));
    const double success = sim::packet_success_probability(Modulation::fsk, ratio_of(form), bits);
    test::expect_closed_form(success, form);
    // The row's own tolerance would let 0 pass for 1.4e-8.
    EXPECT_NEAR(success / form.expected, 1, 1e-6) << form.parameters;
  }
}

TEST(Modulation, PacketsOfTheMicroModemTakeAsLongAsTheReferenceSays) {
  for (const ClosedForm& form : test::closed_forms_of("micromodem_packet_time")) {
    const auto bits = static_cast<std::int64_t>(8 * form.at("frame_bytes") * form.at("frames"));
    test::expect_closed_form(sim::packet_duration_s(bits, form.at("bps")), form);
  }
}

TEST(Modulation, KeepsTheDigitsOfRareErrors) {
  // 1e-12 of 1e5 bits: 1e-7 of the packets, less 5e-15; 1 - (1 - p)^n in plain numbers is wrong by 1e-5 of that.
  EXPECT_NEAR(1 - sim::packet_success_probability(1e-12, 100000), 1e-7, 1e-14);
  EXPECT_DOUBLE_EQ(std::log(sim::packet_success_probability(1e-3, 100000)), 1e5 * std::log1p(-1e-3));
  // erfc(x) = exp(-x^2) / (x sqrt(pi)) (1 - 1/(2 x^2) + 3/(4 x^4) ...) far out.
  const double g = 100, first = 0.5 * std::exp(-g) / std::sqrt(g * 3.14159265358979);
  EXPECT_NEAR(sim::bit_error_probability(Modulation::psk, PowerRatio(g)) / first, 1 - 1 / (2 * g) + 3 / (4 * g * g),
              2e-6);
}

TEST(Modulation, WithoutASignalHalfOfTheBitsAreWrong) {
  for (const Modulation each : {Modulation::fsk, Modulation::psk, Modulation::dpsk}) {
    EXPECT_EQ(sim::bit_error_probability(each, PowerRatio(0)), 0.5) << sim::to_string(each);
    EXPECT_DOUBLE_EQ(sim::packet_success_probability(each, PowerRatio(0), 8), 1.0 / 256) << sim::to_string(each);
    EXPECT_EQ(sim::packet_success_probability(each, PowerRatio(0), 0), 1) << "nothing can be wrong";
  }
}

TEST(Modulation, FadingFromBitToBitIsTheMeanOverTheFades) {
  // Rayleigh's amplitude: the power is exponential about its mean.  Midpoints up to 60 times the mean.
  for (const double mean : {0.5, 4.0, 20.0}) {
    double sum = 0;
    const double width = mean * 60 / 200000;
    for (int i = 0; i < 200000; ++i) {
      const double g = (i + 0.5) * width;
      sum += sim::bit_error_probability(Modulation::fsk, PowerRatio(g)) * std::exp(-g / mean) / mean * width;
    }
    EXPECT_NEAR(sum, sim::bit_error_rayleigh_fsk(PowerRatio(mean)), 1e-7) << mean;
  }
}

TEST(Modulation, ACodeIsWorthItsGain) {
  EXPECT_DOUBLE_EQ(
      sim::packet_success_probability(Modulation::psk, sim::to_power(Decibels(4)), 512, Decibels(3)),
      sim::packet_success_probability(Modulation::psk, sim::to_power(Decibels(4)) * sim::to_power(Decibels(3)), 512));
}

TEST(Modulation, ASlowerRateHasMoreEnergyPerBit) {
  // 80 bit/s in 4 kHz: 10 log10(50) = 17 dB over the power ratio in the band.
  const PowerRatio snr = sim::to_power(Decibels(-5));
  EXPECT_NEAR(sim::to_decibels(sim::energy_per_bit(snr, 4000, 80)).dB(), -5 + 10 * std::log10(50.0), 1e-12);
}

}  // namespace
