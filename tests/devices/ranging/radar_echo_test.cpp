// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/radar_echo.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "devices/common/radio_horizon.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using devices::RadarParams;

constexpr auto horizontal = RadarParams::Polarization::horizontal, vertical = RadarParams::Polarization::vertical;

double reflectivity_dB(double grazing_deg, double frequency_GHz, double sea_state, RadarParams::Polarization kind) {
  return 10 *
         std::log10(devices::sea_reflectivity(sim::degrees_to_radians(grazing_deg), frequency_GHz, sea_state, kind));
}

TEST(RadarEcho, ReflectivityOfTheSeaIsThatOfTheModel) {
  // The formula of the report, calculated elsewhere; in X and S band.
  EXPECT_NEAR(reflectivity_dB(1, 9.41, 3, horizontal), -43.740, 1e-3);
  EXPECT_NEAR(reflectivity_dB(1, 9.41, 3, vertical), -41.571, 1e-3);
  EXPECT_NEAR(reflectivity_dB(1, 3.05, 3, horizontal), -52.485, 1e-3);
  // Calmer seas and smaller angles return less; beyond the horizon nothing does.
  EXPECT_LT(reflectivity_dB(1, 9.41, 1, horizontal), reflectivity_dB(1, 9.41, 3, horizontal));
  EXPECT_LT(reflectivity_dB(0.1, 9.41, 3, horizontal), reflectivity_dB(1, 9.41, 3, horizontal));
  EXPECT_EQ(devices::sea_reflectivity(-1e-6, 9.41, 3, horizontal), 0);
  EXPECT_EQ(devices::sea_reflectivity(1.2, 9.41, 3, horizontal), devices::sea_reflectivity(1.1, 9.41, 3, horizontal));
}

TEST(RadarEcho, NoiseAndConstantFollowFromTheDataSheet) {
  RadarParams radar;
  radar.pulse_s = 1e-7;
  radar.noise_figure_dB = 4;
  EXPECT_NEAR(10 * std::log10(radar.noise_mW()), -173.975 + 70 + 4, 1e-3);  // k 290 K = -173.975 dBm/Hz
  EXPECT_NEAR(radar.pulse_m(), 14.99, 0.01);
  radar.horizontal_rad = sim::degrees_to_radians(2);
  radar.vertical_rad = sim::degrees_to_radians(13);
  EXPECT_NEAR(radar.gain(), 1000, 1e-9);
  radar.frequency_GHz = 10;
  radar.losses_dB = 0;
  radar.peak_power_W = 1;
  // 1 W, 30 dB twice, wavelength 29.979 mm: 30 + 60 - 30.464 - 32.976 dB.
  EXPECT_NEAR(10 * std::log10(radar.echo_constant_mWm2()), 26.560, 1e-3);
}

TEST(RadarEcho, SeaStateIsThatOfTheWavesElseOfTheWind) {
  const auto sea_state = [](const std::string& medium) {
    test::TestWorld test("shoal: 1\nmedium: " + medium + "\n");
    return devices::sea_state_of(test.world.medium());
  };
  for (const int state : {1, 3, 6})
    EXPECT_NEAR(sea_state("{water: {}, waves: {sea_state: " + std::to_string(state) + "}}"), state, 1e-6);
  EXPECT_NEAR(sea_state("{water: {}, waves: {hs_m: 1.38}}"), 3.5, 1e-6);  // half-way from 0.88 to 1.88 m
  EXPECT_EQ(sea_state("{water: {}, waves: {hs_m: 8, tp_s: 14}}"), 6);     // the largest of the model
  EXPECT_NEAR(sea_state("{water: {}, wind: {velocity_mps: [6.32, 0, 0]}}"), std::pow(2, 1.25), 1e-9);
  EXPECT_EQ(sea_state("{water: {}}"), 0);
}

TEST(RadarEcho, TheHorizonIsThatOfFourThirdsOfTheEarth) {
  EXPECT_NEAR(devices::radio_horizon_m(10), 13034, 1);  // 4.12 km sqrt(h / 1 m)
  EXPECT_EQ(devices::height_below_horizon_m(13000, 10), 0);
  EXPECT_NEAR(devices::height_below_horizon_m(2 * 13034, 10), 10, 0.01);  // as far beyond as before
  EXPECT_NEAR(devices::sea_grazing_rad(13034, 10), 0, 1e-7);
}

TEST(RadarEcho, TextureHasMeanOneAndTheVarianceOfItsShape) {
  for (const double shape : {0.3, 1.0, 4.0}) {
    sim::Random random(1, "texture");
    constexpr int count = 100000;
    double sum = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
      const double value = devices::clutter_texture(shape, random);
      sum += value;
      squares += value * value;
    }
    const double mean = sum / count, variance = squares / count - mean * mean;
    EXPECT_NEAR(mean, 1, 4 * std::sqrt(1 / shape / count));
    // The fourth moment of a gamma distribution is 3 + 6 / shape squared variances.
    EXPECT_NEAR(variance * shape, 1, 4 * std::sqrt((2 + 6 / shape) / count));
  }
}

TEST(RadarEcho, DetectedPowerIsTheSumWithTheSpreadOfItsInterference) {
  for (const double steady : {0.0, 3.0}) {
    sim::Random random(1, "detector");
    constexpr int count = 100000;
    double sum = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
      const double power = devices::detected_mW(steady, 2, random);
      sum += power;
      squares += power * power;
    }
    const double variance = 2 * 2 + 2 * steady * 2;  // of a Rice distribution: n^2 + 2 s n
    EXPECT_NEAR(sum / count, steady + 2, 4 * std::sqrt(variance / count));
    EXPECT_NEAR(squares / count - std::pow(sum / count, 2), variance, 0.05 * variance);  // more than 4 standard errors
  }
}

}  // namespace
