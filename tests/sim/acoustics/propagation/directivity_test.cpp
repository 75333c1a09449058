// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/directivity.hpp"

#include <gmock/gmock.h>
#include <math.h>  // j1 is not in <cmath>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "tests/sim/acoustics/config_text.hpp"

namespace {

using sim::DirectivityConfig;
using sim::Vector3d;
using Pattern = DirectivityConfig::Pattern;

using std::numbers::pi;
constexpr double c_mps = 1500;
constexpr double frequency_Hz = 25000;
constexpr double k_pm = 2 * pi * frequency_Hz / c_mps;

double gain_dB(const DirectivityConfig& config, const Vector3d& direction_S) {
  return sim::directivity_gain(config, direction_S, frequency_Hz, c_mps).dB();
}
Vector3d off_axis(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad), 0};
}

TEST(Directivity, APistonIsHalfAsStrongWhereItsBeamEnds) {
  const DirectivityConfig piston{Pattern::piston, 0.12};
  const double ka = k_pm * 0.06;
  // (2 J1(x) / x)^2 = 1/2 at x = 1.61634.
  EXPECT_NEAR(gain_dB(piston, off_axis(std::asin(1.61634 / ka))), -10 * std::log10(2.0), 1e-4);
  EXPECT_EQ(gain_dB(piston, Vector3d(7, 0, 0)), 0);
  EXPECT_NEAR(gain_dB(piston, off_axis(0.4)), gain_dB(piston, Vector3d(std::cos(0.4), 0, -std::sin(0.4))), 1e-12);
}

TEST(Directivity, APistonHasANullAndASideLobe) {
  const DirectivityConfig piston{Pattern::piston, 0.2, 0.1, -60};
  const double ka = k_pm * 0.1;
  // J1 is zero at 3.8317; its quotient is deepest between that and the next at 5.1356: 0.1323, -17.57 dB.
  EXPECT_EQ(gain_dB(piston, off_axis(std::asin(3.831706 / ka))), -60);
  EXPECT_NEAR(gain_dB(piston, off_axis(std::asin(5.1356 / ka))), -17.57, 0.01);
  EXPECT_EQ(gain_dB(piston, Vector3d(-1, 0.1, 0)), -60) << "nothing goes through the baffle";
}

TEST(Directivity, ALineIsLevelAllAround) {
  const DirectivityConfig line{Pattern::toroid, 0.1, 0.15};
  EXPECT_EQ(gain_dB(line, Vector3d(3, -4, 0)), 0);
  const auto up = [](double elevation_rad) { return Vector3d(std::cos(elevation_rad), 0, std::sin(elevation_rad)); };
  // sin(u) / u is 1 / sqrt(2) at 1.391557.
  EXPECT_NEAR(gain_dB(line, up(std::asin(1.391557 / (k_pm * 0.075)))), -10 * std::log10(2.0), 1e-4);
  EXPECT_NEAR(gain_dB(line, up(0.2)), gain_dB(line, up(-0.2)), 1e-12);
}

TEST(Directivity, AHemisphereIsDeafBehind) {
  const DirectivityConfig half{Pattern::hemisphere, 0.1, 0.1, -40};
  EXPECT_EQ(gain_dB(half, Vector3d(0.1, 5, 5)), 0);
  EXPECT_EQ(gain_dB(half, Vector3d(-0.1, 5, 5)), -40);
}

TEST(Directivity, IndexIsThatOfTheClosedForms) {
  const auto index = [](const DirectivityConfig& config) {
    return sim::directivity_index(config, frequency_Hz, c_mps).dB();
  };
  EXPECT_EQ(index({}), 0);
  EXPECT_NEAR(index({Pattern::hemisphere, 0.1, 0.1, -200}), 10 * std::log10(2.0), 1e-6);
  // A piston in a baffle: (ka)^2 / (1 - J1(2 ka) / ka) (Kinsler et al., chapter 7).  The midpoint rule: 1e-4 dB.
  for (const double diameter_m : {0.02, 0.1, 0.3}) {
    const double ka = k_pm * diameter_m / 2;
    EXPECT_NEAR(index({Pattern::piston, diameter_m, 0.1, -200}), 10 * std::log10(ka * ka / (1 - ::j1(2 * ka) / ka)),
                1e-4)
        << diameter_m;
  }
  // A long line: 2 L / wavelength.
  EXPECT_NEAR(index({Pattern::toroid, 0.1, 3, -200}), 10 * std::log10(2 * 3 * frequency_Hz / c_mps), 0.05);
}

RC_GTEST_PROP(Directivity, IsBetweenTheFloorAndTheAxis, ()) {
  const auto part = [](double scale) { return *rc::gen::inRange(-1000, 1001) * scale / 1000; };
  const Pattern pattern = *rc::gen::element(Pattern::omni, Pattern::piston, Pattern::hemisphere, Pattern::toroid);
  const DirectivityConfig config{pattern, 0.01 + std::abs(part(2)), 0.01 + std::abs(part(2)), -std::abs(part(60))};
  const double gain = gain_dB(config, Vector3d(part(1), part(1), part(1)));
  RC_ASSERT(gain <= 0);
  RC_ASSERT(gain >= config.floor_dB);
}

TEST(Directivity, ReportsKeysOfAnotherPattern) {
  using test_support::config_error;
  EXPECT_THAT(config_error<DirectivityConfig>("{pattern: omni, diameter_m: 0.1}"),
              testing::HasSubstr("'diameter_m' is for pattern piston"));
  EXPECT_THAT(config_error<DirectivityConfig>("{pattern: piston, length_m: 0.1}"),
              testing::HasSubstr("'length_m' is for pattern toroid"));
  EXPECT_EQ(test_support::read_config<DirectivityConfig>("{pattern: piston, diameter_m: 0.2}").diameter_m, 0.2);
}

}  // namespace
