// SPDX-License-Identifier: BSD-3-Clause
#include "devices/common/actuator_lag.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/sim/config/read_yaml.hpp"

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

devices::Lag lag_of(const devices::LagParams& params, double rate_limit = no_limit) {
  devices::Lag lag;
  lag.set(params, rate_limit);
  return lag;
}

TEST(ActuatorLag, WithoutALagItFollowsAtOnce) {
  devices::Lag lag = lag_of({});
  EXPECT_EQ(lag.follow(3, 0.01), 3);
  EXPECT_EQ(lag.value(), 3);
}

TEST(ActuatorLag, OfFirstOrderTheRestDecaysAlikeInAnySteps) {
  devices::Lag one = lag_of({.lag_s = 0.5}), many = one;
  one.follow(2, 0.5);
  for (int i = 0; i < 100; ++i) many.follow(2, 0.005);
  EXPECT_NEAR(one.value(), 2 * (1 - std::exp(-1)), 1e-12);
  EXPECT_NEAR(many.value(), one.value(), 1e-12);
}

TEST(ActuatorLag, OfSecondOrderItOvershootsByTheDampingRatio) {
  // The first peak of a step response is after half a damped period, 1 + exp(-pi z / sqrt(1 - z^2)).
  const double w = 4, z = 0.3, damped = w * std::sqrt(1 - z * z);
  devices::Lag lag = lag_of({.natural_frequency_radps = w, .damping_ratio = z});
  for (int i = 0; i < 1000; ++i) lag.follow(1, std::numbers::pi / damped / 1000);
  EXPECT_NEAR(lag.value(), 1 + std::exp(-std::numbers::pi * z / std::sqrt(1 - z * z)), 1e-9);
  EXPECT_NEAR(lag.rate(), 0, 1e-9);
}

TEST(ActuatorLag, OverdampedAndCriticallyDampedItNeverOvershoots) {
  for (const double z : {1.0, 3.0}) {
    devices::Lag lag = lag_of({.natural_frequency_radps = 4, .damping_ratio = z});
    double before = 0;
    for (int i = 0; i < 500; ++i) {
      EXPECT_GE(lag.follow(1, 0.02), before);
      before = lag.value();
    }
    EXPECT_NEAR(lag.value(), 1, 1e-2);
    EXPECT_LE(lag.value(), 1 + 1e-12);
  }
}

TEST(ActuatorLag, ChangesNoFasterThanItsLimit) {
  devices::Lag lag = lag_of({}, 2);
  EXPECT_NEAR(lag.follow(10, 0.1), 0.2, 1e-12);
  EXPECT_NEAR(lag.follow(-10, 0.1), 0, 1e-12);
}

TEST(ActuatorLag, HalfWayIsTheValueInTheMiddleOfTheStep) {
  devices::Lag lag = lag_of({.lag_s = 1});
  EXPECT_NEAR(lag.follow_through(1, 0.2), 1 - std::exp(-0.1), 1e-12);
  EXPECT_NEAR(lag.value(), 1 - std::exp(-0.2), 1e-12);
  lag.jump_to(5);
  EXPECT_EQ(lag.follow_through(5, 0.2), 5);  // at rest
}

TEST(ActuatorLag, IsOfOneOrder) {
  devices::LagParams params;
  EXPECT_THAT(
      test::errors_of_reading("{lag_s: 1, natural_frequency_radps: 2}", [&](sim::ParamReader& in) { params.read(in); }),
      testing::ElementsAre(testing::HasSubstr("'lag_s' and 'natural_frequency_radps' exclude each other")));
}

}  // namespace
