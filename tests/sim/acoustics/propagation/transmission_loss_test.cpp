// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/transmission_loss.hpp"

#include <gmock/gmock.h>

#include "sim/acoustics/propagation/ambient_noise.hpp"
#include "sim/medium/sea_water.hpp"
#include "tests/fidelity/closed_forms.hpp"
#include "tests/sim/acoustics/config_text.hpp"
#include "tests/sim/medium/medium_worlds.hpp"

namespace {

using sim::AbsorptionConfig;
using sim::Decibels;
using sim::SpreadingConfig;
using test_support::config_error;
using test_support::make_medium;
using test_support::read_config;
using testing::HasSubstr;

Decibels loss(const test::ClosedForm& form) {
  return sim::spreading_loss(form.at("range"), form.at("spreading")) +
         sim::absorption_loss(form.at("range"), sim::thorp_dBpkm(form.at("f_kHz")));
}

TEST(TransmissionLoss, IsThatOfTheReference) {
  for (const auto& form : test::closed_forms_of("acoustic_link", "TL")) test::expect_closed_form(loss(form).dB(), form);
}

TEST(TransmissionLoss, LeavesTheSignalOverNoiseOfTheReference) {
  for (const auto& form : test::closed_forms_of("acoustic_link", "SNR_in_band")) {
    const sim::AmbientNoise sea{form.at("shipping"), form.at("wind_mps"), {}};
    const Decibels noise = sea.band_level(form.at("f_kHz") * 1000, form.at("bandwidth_Hz"));
    const Decibels snr = Decibels(form.at("SL")) - loss(form) - noise + Decibels(form.at("DI"));
    test::expect_closed_form(snr.dB(), form);
  }
}

TEST(TransmissionLoss, TenTimesAsFarIsTenTwentyOrFifteenDecibelsMore) {
  for (const double k : {1.0, 1.5, 2.0})
    EXPECT_NEAR((sim::spreading_loss(2000, k) - sim::spreading_loss(200, k)).dB(), 10 * k, 1e-12) << k;
  EXPECT_EQ(sim::spreading_loss(1, 2).dB(), 0);
  EXPECT_EQ(sim::spreading_loss(0.1, 2).dB(), 0) << "source levels are given at 1 m";
}

TEST(TransmissionLoss, TurnsFromSphericalToCylindricalAtTheTransition) {
  EXPECT_NEAR(sim::spreading_loss_with_transition(100, 100).dB(), 40, 1e-12);
  EXPECT_NEAR(sim::spreading_loss_with_transition(50, 100).dB(), sim::spreading_loss(50, 2).dB(), 1e-12);
  EXPECT_NEAR(sim::spreading_loss_with_transition(1000, 100).dB(), 50, 1e-12);
  EXPECT_EQ(sim::spreading_loss_with_transition(0.5, 100).dB(), 0);
  EXPECT_EQ(sim::spreading_loss(1000, read_config<SpreadingConfig>("transition_range_m: 100")),
            sim::spreading_loss_with_transition(1000, 100));
  EXPECT_EQ(sim::spreading_loss(1000, read_config<SpreadingConfig>("factor: 2")), sim::spreading_loss(1000, 2));
}

TEST(TransmissionLoss, AbsorbsByTheChosenModel) {
  const sim::Medium medium = make_medium("water: {temperature_C: 12, salinity_psu: 34}");
  const sim::Vector3d a(0, 0, -50), b(1000, 0, -50);
  const auto absorption = [&](const std::string& yaml) {
    return sim::absorption_dBpkm(read_config<AbsorptionConfig>(yaml), 25000, medium, a, b);
  };
  EXPECT_EQ(absorption("model: thorp"), sim::thorp_dBpkm(25));
  EXPECT_EQ(absorption("{model: constant, dBpkm: 3.5}"), 3.5);
  EXPECT_NEAR(absorption("pH: 7.9"), sim::francois_garrison_dBpkm(25, {12, 34, 50, 7.9}), 1e-12);
}

TEST(TransmissionLoss, AbsorptionIsTheMeanAlongThePath) {
  const sim::Medium medium = make_medium(R"(
water:
  profile:
    - {depth_m: 0, temperature_C: 18, salinity_psu: 35}
    - {depth_m: 400, temperature_C: 6, salinity_psu: 35}
)");
  double mean = 0;
  for (int i = 0; i < 1000; ++i) {
    const double share = (i + 0.5) / 1000;
    mean += sim::francois_garrison_dBpkm(25, {18 - 12 * share, 35, 400 * share, 8}) / 1000;
  }
  const sim::Vector3d top(0, 0, -1e-9), bottom(300, 0, -400);
  // Simpson's rule with one piece; the absorption changes by half on the way, smoothly.
  EXPECT_NEAR(sim::absorption_dBpkm({}, 25000, medium, top, bottom), mean, 0.002 * mean);
  EXPECT_DOUBLE_EQ(sim::absorption_dBpkm({}, 25000, medium, bottom, top),
                   sim::absorption_dBpkm({}, 25000, medium, top, bottom));
}

TEST(TransmissionLoss, ReportsKeysThatDoNotGoTogether) {
  EXPECT_THAT(config_error<SpreadingConfig>("{factor: 2, transition_range_m: 10}"), HasSubstr("exclude each other"));
  EXPECT_THAT(config_error<SpreadingConfig>("{factor: -1}"), HasSubstr("'factor' must be >= 0 and <= 4, got -1"));
  EXPECT_THAT(config_error<AbsorptionConfig>("{model: thorp, dBpkm: 1}"), HasSubstr("'dBpkm' is for model constant"));
  EXPECT_THAT(config_error<AbsorptionConfig>("{model: thorp, pH: 8}"),
              HasSubstr("'pH' is for model francois_garrison"));
}

}  // namespace
