// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/rays/caustic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

constexpr double pi = std::numbers::pi;

/// z of the argument -x of the Airy function.
double z_of(double x) {
  return 2.0 / 3 * std::pow(x, 1.5);
}

TEST(Caustic, TwoRaysOfOneLevelAddUpToTheAiryFunction) {
  // Ai(-x): Abramowitz and Stegun, Handbook of Mathematical Functions, table 10.11.  The pressures are 1 by ray tubes.
  for (const auto& [x, airy] : {std::pair{1e-6, 0.35502831},
                                {0.5, 0.47572809},
                                {1.0, 0.53556088},
                                {2.0, 0.22740743},
                                {3.0, -0.37881429},
                                {5.0, 0.35076101}}) {
    const double z = z_of(x);
    const sim::CausticChange change = sim::caustic_change(2 * z);
    const double sum = 2 * std::sqrt(change.power) * std::cos(z - pi / 4 + change.later_rad);
    EXPECT_NEAR(sum, 2 * std::sqrt(pi) * std::pow(x, 0.25) * airy, 1e-7) << x;
  }
  // The first zero of the function: silence.
  const double z = z_of(2.33810741);
  EXPECT_NEAR(std::cos(z - pi / 4 + sim::caustic_change(2 * z).later_rad), 0, 1e-7);
}

TEST(Caustic, FarFromItNothingChanges) {
  for (const double apart_rad : {199.0, 201.0, 1e6}) {
    const sim::CausticChange change = sim::caustic_change(apart_rad);
    EXPECT_NEAR(change.power, 1, 1e-5) << apart_rad;
    EXPECT_NEAR(change.later_rad, 0, 1e-3) << apart_rad;
  }
}

TEST(Caustic, AtItThePowerIsThatOfTheHankelFunction) {
  // The power by a ray tube grows with z^(-1/3), so this factor falls with z^(1/3).
  const double gamma = std::tgamma(1.0 / 3) / pi;
  for (const double z : {1e-9, 1e-15})
    EXPECT_NEAR(sim::caustic_change(2 * z).power / std::cbrt(z), pi / 2 * gamma * gamma * std::cbrt(4.0), 1e-5);
  EXPECT_TRUE(std::isfinite(sim::caustic_change(0).later_rad));
}

}  // namespace
