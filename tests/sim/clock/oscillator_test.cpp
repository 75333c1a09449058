// SPDX-License-Identifier: BSD-3-Clause
#include "sim/clock/oscillator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/clock/vehicle_clock.hpp"
#include "sim/random/allan.hpp"
#include "tests/sim/clock/made_clocks.hpp"

namespace {

using namespace made_clocks;

using sim::Time;
using sim::VehicleClock;

/// Mean frequency errors over intervals of `dt_s`.
std::vector<double> rates(const sim::ClockConfig& config, double dt_s, int count, std::uint64_t seed = 1) {
  VehicleClock clock = made(config, seed);
  std::vector<double> all;
  double before_s = clock.error_s(Time{0});
  for (int i = 1; i <= count; ++i) {
    const Time now = sim::from_seconds(i * dt_s);
    clock.advance_to(now, {});
    const double error_s = clock.error_s(now);
    all.push_back((error_s - before_s) / dt_s);
    before_s = error_s;
  }
  return all;
}

/// Expects the Allan deviation of the rates to be `expected`, within four standard deviations of its estimate and a
/// `share` for what the model itself leaves.
void expect_allan(const std::vector<double>& rates, double dt_s, double tau_s, double expected, double share = 0) {
  const sim::AllanPoint point = sim::allan_deviation_at(rates, dt_s, tau_s);
  EXPECT_NEAR(point.deviation, expected, expected * (4 * point.relative_error + share)) << tau_s;
}

TEST(VehicleClock, WhiteNoiseOfTheFrequencyHasTheAllanDeviationAskedForAndTheSlopeMinusOneHalf) {
  const auto y = rates({.white_fm = 2e-9}, 1, 40000);
  for (const double tau_s : {1.0, 10.0, 100.0, 1000.0}) expect_allan(y, 1, tau_s, 2e-9 / std::sqrt(tau_s));
}

TEST(VehicleClock, RandomWalkOfTheFrequencyHasTheSlopePlusOneHalf) {
  const auto y = rates({.random_walk_fm = 3e-12}, 1, 100000);
  for (const double tau_s : {1.0, 10.0, 100.0, 1000.0}) expect_allan(y, 1, tau_s, 3e-12 * std::sqrt(tau_s / 3));
}

TEST(VehicleClock, TheIntervalOfItsUpdatesDoesNotChangeItsAllanDeviation) {
  const auto y = rates({.white_fm = 1e-9, .random_walk_fm = 1e-11, .update_s = 10}, 10, 20000);
  for (const double tau_s : {10.0, 100.0, 1000.0})
    expect_allan(y, 10, tau_s, std::hypot(1e-9 / std::sqrt(tau_s), 1e-11 * std::sqrt(tau_s / 3)));
}

/// Allan deviation of the sum of Gauss-Markov processes that stands for a flicker floor of 1; each by
/// sigma^2 = 2 / x (1 - (3 - 4 exp(-x) + exp(-2 x)) / (2 x)), x the averaging time over the correlation time.
double flicker_model(double tau_s) {
  double variance = 0;
  for (const double time_s : sim::flicker_times_s()) {
    const double x = tau_s / time_s;
    variance += 2 / x * (1 - (3 - 4 * std::exp(-x) + std::exp(-2 * x)) / (2 * x));
  }
  return sim::flicker_process_std() * std::sqrt(variance);
}

TEST(VehicleClock, TheSumOfGaussMarkovProcessesIsAFlatAllanDeviation) {
  for (double tau_s = 10; tau_s < 3e4; tau_s *= 1.3) EXPECT_NEAR(flicker_model(tau_s), 1, 0.05) << tau_s;
}

TEST(VehicleClock, FlickerNoiseHasTheFloorAskedFor) {
  const auto y = rates({.flicker_floor = 5e-10}, 1, 100000);
  for (const double tau_s : {10.0, 100.0, 1000.0}) expect_allan(y, 1, tau_s, 5e-10 * flicker_model(tau_s), 0.01);
}

TEST(VehicleClock, FollowsTheTemperatureOfTheWater) {
  VehicleClock clock = made({.temperature_ppm_per_C = 0.05});
  EXPECT_FALSE(clock.wants_temperature(Time{0}));  // it is planned ahead for 3 s
  EXPECT_TRUE(clock.wants_temperature(Time{1'000'000}));
  for (int second = 1; second <= 3600; ++second) clock.advance_to(Time{1'000'000LL * second}, 4.0);
  // 16 C below its reference: -0.8 ppm, from 3 s on (until then it was planned ahead in air).
  EXPECT_NEAR(clock.error_s(hour), -0.8e-6 * 3597, 2e-12);
  EXPECT_NEAR(clock.rate_error(hour), -0.8e-6, 1e-12);
}

}  // namespace
