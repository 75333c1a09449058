// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/echoes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using sim::Echoes;
using sim::MultipathConfig;
using sim::MultipathMedium;

constexpr double no_bottom = std::numeric_limits<double>::infinity();

/// A surface that mirrors all, 1500 m/s, spherical spreading, no absorption.
MultipathConfig mirror() {
  MultipathConfig config;
  config.max_bounces = 1;
  config.surface_loss_dB = 0;
  return config;
}
MultipathMedium clear(double frequency_Hz = 25000) {
  return {frequency_Hz, 1500, 0, 0, {2, {}}};
}

TEST(Echoes, AddPowersWithoutPhases) {
  // 20 m deep, 40 m apart: the surface path is sqrt(2) times as long, half the power, 11.05 ms later.
  MultipathConfig config = mirror();
  config.window_s = 0.0111;
  const Echoes near = sim::echoes(config, clear(), {20, 20, 40, no_bottom}, nullptr);
  EXPECT_NEAR(near.signal.linear(), 1.5, 1e-9);
  EXPECT_EQ(near.late.linear(), 0);
  config.window_s = 0.0110;
  const Echoes late = sim::echoes(config, clear(), {20, 20, 40, no_bottom}, nullptr);
  EXPECT_NEAR(late.signal.linear(), 1, 1e-12);
  EXPECT_NEAR(late.late.linear(), 0.5, 1e-9);
}

TEST(Echoes, KeepThePhasesOfTheLengthsWhenTheseAreAsked) {
  MultipathConfig config = mirror();
  config.phases = MultipathConfig::Phases::geometric;
  config.window_s = 1;
  // A wavelength of the difference in length: silence except for the difference in spreading.
  const double longer_m = 40 * (std::sqrt(2.0) - 1);
  EXPECT_NEAR(sim::echoes(config, clear(1500 / longer_m), {20, 20, 40, no_bottom}, nullptr).signal.linear(),
              std::pow(1 - 1 / std::sqrt(2.0), 2), 1e-9);
}

TEST(Echoes, DrawnPhasesStayBetweenSilenceAndTheSum) {
  const MultipathConfig config = mirror();
  sim::Random random(1, "a>b");
  double low = 9, high = 0;
  for (int packet = 0; packet < 200; ++packet) {
    random.begin_step(packet);
    const double signal = sim::echoes(config, clear(), {5, 5, 500, no_bottom}, &random).signal.linear();
    low = std::min(low, signal);
    high = std::max(high, signal);
  }
  EXPECT_LT(low, 0.05);
  EXPECT_GT(high, 3.9);
  EXPECT_LE(high, 4);
}

TEST(Echoes, NoneWithoutBounces) {
  MultipathConfig config = mirror();
  config.max_bounces = 0;
  const Echoes none = sim::echoes(config, clear(), {20, 30, 400, 50}, nullptr);
  EXPECT_EQ(none.signal.linear(), 1);
  EXPECT_EQ(none.late.linear(), 0);
  EXPECT_EQ(none.spread_s, 0);
}

TEST(Echoes, AreThereWhereNothingIsLeftOfTheSound) {
  // 1e6 m at 6 dB/km: powers of 1e-600 are zero as numbers, their ratios are not.
  MultipathMedium far = clear();
  far.absorption_dBpkm = 6;
  EXPECT_NEAR(sim::echoes(mirror(), far, {20, 20, 1e6, no_bottom}, nullptr).signal.linear(), 2, 1e-3);
}

TEST(Echoes, OfEndsBeyondTheWaterAreThoseAtItsBounds) {
  MultipathConfig config = mirror();
  config.max_bounces = 3;
  const auto at = [&](double source_m, double receiver_m) {
    return sim::echoes(config, clear(), {source_m, receiver_m, 400, 50}, nullptr).signal.linear();
  };
  EXPECT_EQ(at(-1, 60), at(0, 50));
}

}  // namespace
