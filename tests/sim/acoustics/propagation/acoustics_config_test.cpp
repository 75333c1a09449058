// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/acoustics_config.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/sim/acoustics/config_text.hpp"

namespace {

using sim::FadingConfig;
using test_support::config_error;

std::vector<double> fades_dB(const FadingConfig& config, int packets) {
  sim::Random random(3, "fades");
  std::vector<double> all;
  for (int i = 0; i < packets; ++i) {
    random.begin_step(i);
    all.push_back(sim::fade(config, random).dB());
  }
  return all;
}

TEST(Fading, OfRayleighHasTheMeanPowerAndAnExponentialTail) {
  const int packets = 40000;
  double mean = 0;
  int deep = 0;
  for (const double dB : fades_dB({FadingConfig::Type::rayleigh}, packets)) {
    mean += std::pow(10, dB / 10) / packets;
    deep += dB < -10;
  }
  // Standard deviation of an exponential: its mean.  4 standard errors.
  EXPECT_NEAR(mean, 1, 4 / std::sqrt(packets));
  const double share = 1 - std::exp(-0.1);
  EXPECT_NEAR(deep, share * packets, 4 * std::sqrt(share * packets));
}

TEST(Fading, LogNormalHasItsMedianAtNoGainAndItsDeviation) {
  std::vector<double> all = fades_dB({FadingConfig::Type::log_normal, 6}, 20000);
  double squares = 0;
  for (const double dB : all) squares += dB * dB / 20000;
  std::nth_element(all.begin(), all.begin() + 10000, all.end());
  EXPECT_NEAR(all[10000], 0, 4 * 1.2533 * 6 / std::sqrt(20000));
  EXPECT_NEAR(std::sqrt(squares), 6, 4 * 6 / std::sqrt(2 * 20000));
}

TEST(Fading, NoneDrawsNothing) {
  sim::Random random(3, "fades"), untouched(3, "fades");
  random.begin_step(1);
  untouched.begin_step(1);
  EXPECT_EQ(sim::fade({}, random).dB(), 0);
  EXPECT_EQ(random.bits(), untouched.bits());
}

TEST(Fading, ReportsAKeyOfAnotherType) {
  EXPECT_THAT(config_error<FadingConfig>("{type: rayleigh, std_dB: 3}"),
              testing::HasSubstr("'std_dB' is for type log_normal"));
}

}  // namespace
