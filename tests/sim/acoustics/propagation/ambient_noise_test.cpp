// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/ambient_noise.hpp"

#include <gmock/gmock.h>

#include "tests/fidelity/closed_forms.hpp"
#include "tests/sim/acoustics/config_text.hpp"

namespace {

using sim::AmbientNoise;
using sim::Decibels;
using sim::PowerRatio;

TEST(AmbientNoise, HasTheSpectrumOfTheReference) {
  for (const auto& form : test::closed_forms_of("ambient_noise_wenz_coates")) {
    const AmbientNoise sea{form.at("shipping"), form.at("wind_mps"), {}};
    test::expect_closed_form(sea.spectral_level(form.at("f_kHz")).dB(), form);
  }
}

TEST(AmbientNoise, InANarrowBandIsTheSpectrumTimesTheBand) {
  // The spectrum falls by 18 dB per decade there: the curvature over a sixth of the frequency is below 0.05 dB.
  for (const double wind_mps : {0.0, 5.0, 15.0}) {
    const AmbientNoise sea{0.5, wind_mps, {}};
    const double narrow_dB = sea.spectral_level(25).dB() + 10 * std::log10(4000.0);
    EXPECT_NEAR(sea.band_level(25000, 4000).dB(), narrow_dB, 0.1) << wind_mps;
    EXPECT_NEAR(sea.band_level(25000, 1).dB(), sea.spectral_level(25).dB(), 1e-6) << wind_mps;
  }
}

TEST(AmbientNoise, InAWideBandIsTheSumOfItsParts) {
  const AmbientNoise sea{0.5, 5, {}};
  const double parts_dB =
      sim::to_decibels(sim::to_power(sea.band_level(550, 900)) + sim::to_power(sea.band_level(5500, 9000)) +
                       sim::to_power(sea.band_level(15000, 10000)))
          .dB();
  EXPECT_NEAR(sea.band_level(10050, 19900).dB(), parts_dB, 1e-4);
  PowerRatio sum;
  for (int f_Hz = 100; f_Hz < 20000; ++f_Hz) sum += sim::to_power(sea.spectral_level((f_Hz + 0.5) / 1000));
  EXPECT_NEAR(sea.band_level(10050, 19900).dB(), sim::to_decibels(sum).dB(), 1e-3);
}

TEST(AmbientNoise, IsTheWatersHeatAtHighFrequencies) {
  // Thermal noise is -15 + 20 log f alone when all is calm (Mellen, JASA 24, 1952).
  const AmbientNoise calm{0, 0, {}};
  EXPECT_NEAR(calm.spectral_level(500).dB(), -15 + 20 * std::log10(500.0), 0.1);
}

TEST(AmbientNoise, GrowsWithShipsAndWindWhereTheseAreReceived) {
  const auto level = [](double shipping, double wind_mps, double f_kHz) {
    return AmbientNoise{shipping, wind_mps, {}}.spectral_level(f_kHz).dB();
  };
  // At 100 Hz ships are 10 dB over the rest even when there are few; at 10 kHz the wind is 6 dB over the rest.
  EXPECT_NEAR(level(1, 0, 0.1) - level(0, 0, 0.1), 20, 0.6);
  EXPECT_NEAR(level(0, 16, 10) - level(0, 4, 10), 7.5 * (4 - 2), 0.2);
  EXPECT_NEAR(level(1, 5, 100) - level(0, 5, 100), 0, 0.1);
  EXPECT_DOUBLE_EQ((AmbientNoise{0, 5, Decibels(12)}.spectral_level(25).dB()), level(0, 5, 25) + 12);
}

TEST(AmbientNoise, TakesTheWindOfTheMediumUnlessItHasItsOwn) {
  const auto of_medium = test_support::read_config<sim::NoiseConfig>("{shipping: 1, offset_dB: 3}");
  EXPECT_EQ(of_medium.with_wind(7).wind_mps, 7);
  EXPECT_EQ(of_medium.with_wind(7).offset, Decibels(3));
  EXPECT_EQ(test_support::read_config<sim::NoiseConfig>("wind_mps: 2").with_wind(7).wind_mps, 2);
  EXPECT_THAT(test_support::config_error<sim::NoiseConfig>("shipping: 2"),
              testing::HasSubstr("'shipping' must be >= 0 and <= 1, got 2"));
}

}  // namespace
