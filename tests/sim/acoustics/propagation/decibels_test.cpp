// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/decibels.hpp"

#include <gtest/gtest.h>

#include <concepts>
#include <limits>

namespace {

using sim::Decibels;
using sim::PowerRatio;
using sim::to_decibels;
using sim::to_power;

template <typename A, typename B>
concept CanAdd = requires(A a, B b) {
  a + b;
};
template <typename A, typename B>
concept CanMultiply = requires(A a, B b) {
  a* b;
};
template <typename A, typename B>
concept CanCompare = requires(A a, B b) {
  a < b;
};

// Each of these is a mistake that has been made somewhere.
static_assert(CanAdd<Decibels, Decibels> && CanAdd<PowerRatio, PowerRatio>);
static_assert(!CanAdd<Decibels, PowerRatio> && !CanAdd<PowerRatio, Decibels>);
static_assert(!CanAdd<Decibels, double> && !CanAdd<PowerRatio, double>);
static_assert(CanMultiply<PowerRatio, PowerRatio> && CanMultiply<double, Decibels>);
static_assert(!CanMultiply<Decibels, Decibels> && !CanMultiply<Decibels, PowerRatio>);
static_assert(!CanCompare<Decibels, PowerRatio> && !CanCompare<Decibels, double>);
static_assert(!std::convertible_to<double, Decibels> && !std::convertible_to<Decibels, double>);
static_assert(!std::convertible_to<double, PowerRatio> && !std::convertible_to<PowerRatio, double>);
static_assert(!std::convertible_to<Decibels, PowerRatio> && !std::convertible_to<PowerRatio, Decibels>);

TEST(Decibels, AreTenTimesTheLogarithmOfThePower) {
  EXPECT_DOUBLE_EQ(to_decibels(PowerRatio(1000)).dB(), 30);
  EXPECT_DOUBLE_EQ(to_power(Decibels(-20)).linear(), 0.01);
  EXPECT_NEAR(sim::pressure_level(-10).dB(), 20, 1e-12);
  for (const double dB : {-180.0, -3.0, 0.0, 6.0, 220.0})
    EXPECT_NEAR(to_decibels(to_power(Decibels(dB))).dB(), dB, 1e-12);
}

TEST(Decibels, TwoEqualPowersAreThreeDecibelsMore) {
  const PowerRatio one = to_power(Decibels(60));
  EXPECT_NEAR(to_decibels(one + one).dB(), 60 + 10 * std::log10(2.0), 1e-12);
}

TEST(Decibels, GainsOneAfterTheOtherMultiplyThePowers) {
  const Decibels a(13), b(-41);
  EXPECT_NEAR(to_power(a + b).linear(), (to_power(a) * to_power(b)).linear(), 1e-18);
  EXPECT_NEAR(to_power(a - b).linear(), (to_power(a) / to_power(b)).linear(), 1e-9);
}

TEST(Decibels, NoPowerIsMinusInfinityAndBack) {
  EXPECT_EQ(to_decibels(PowerRatio(0)).dB(), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_power(to_decibels(PowerRatio(0))).linear(), 0);
}

TEST(Decibels, AWattHas171DecibelsAtAMeter) {
  // W = p^2 4 pi r^2 / (rho c).
  const double p_Pa = std::sqrt(1.54e6 / (4 * 3.14159265358979));
  EXPECT_NEAR(sim::one_watt_level.dB(), sim::pressure_level(p_Pa / sim::reference_pressure_Pa).dB(), 0.05);
}

}  // namespace
