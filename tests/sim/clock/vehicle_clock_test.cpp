// SPDX-License-Identifier: BSD-3-Clause
#include "sim/clock/vehicle_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/random/allan.hpp"
#include "tests/sim/clock/made_clocks.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using namespace made_clocks;

using sim::Time;
using sim::VehicleClock;

std::uint64_t hash_of(const VehicleClock& clock) {
  return test::state_hash_of(clock);
}

TEST(VehicleClock, WithoutConfigurationReadsTheTrueTime) {
  const VehicleClock clock;
  EXPECT_TRUE(clock.perfect());
  EXPECT_EQ(clock.reading(hour), hour);
  EXPECT_EQ(clock.true_time(hour), hour);
  EXPECT_EQ(clock.error_s(hour), 0);
  EXPECT_EQ(clock.rate_error(hour), 0);
  EXPECT_EQ(clock.estimated_std_s(hour), 0);
  EXPECT_TRUE(made({}).perfect());
  EXPECT_EQ(hash_of(clock), sim::StateArchive::hasher().hash());
}

TEST(VehicleClock, OnePartInAMillionGains3600MicrosecondsInAnHour) {
  VehicleClock clock = made({.offset_s = 2, .drift_ppm = 1});
  EXPECT_EQ(clock.reading(Time{0}), Time{2'000'000});
  EXPECT_EQ(clock.reading(hour), hour + Time{2'003'600});
  EXPECT_NEAR(clock.error_s(hour), 2.0036, 1e-12);
  EXPECT_NEAR(clock.rate_error(Time{0}), 1e-6, 1e-15);
  clock.advance_to(hour, {});
  EXPECT_EQ(clock.reading(hour), hour + Time{2'003'600});
  EXPECT_EQ(clock.reading(Time{500'000}), Time{2'500'001});  // the nearest microsecond of 2500000.5
}

TEST(VehicleClock, StartsWithItsOffsetWhenTheVehicleComes) {
  const VehicleClock clock({.offset_s = -1, .drift_ppm = 100}, 1, "auv", hour);
  EXPECT_EQ(clock.reading(hour), hour - Time{1'000'000});
  EXPECT_EQ(clock.reading(hour + Time{1'000'000}), hour + Time{100});
}

TEST(VehicleClock, ReadsWholeTicksRoundedDown) {
  const VehicleClock clock = made({.offset_s = -0.25, .resolution_s = 0.001});
  EXPECT_EQ(clock.reading(Time{1'000'999}), Time{750'000});
  EXPECT_EQ(clock.reading(Time{1'001'000}), Time{751'000});
  EXPECT_EQ(clock.reading(Time{100'100}), Time{-150'000});  // -149.9 ms, rounded down
}

TEST(VehicleClock, DrawsOffsetAndDriftOncePerVehicle) {
  double offsets = 0, drifts = 0;
  constexpr int count = 2000;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const VehicleClock clock = made({.offset_std_s = 0.5, .drift_std_ppm = 3}, seed);
    offsets += std::pow(clock.error_s(Time{0}), 2);
    drifts += std::pow(clock.rate_error(Time{0}), 2);
  }
  const double allowed = 4 / std::sqrt(2.0 * count);
  EXPECT_NEAR(std::sqrt(offsets / count), 0.5, 0.5 * allowed);
  EXPECT_NEAR(std::sqrt(drifts / count), 3e-6, 3e-6 * allowed);
  const VehicleClock other({.offset_std_s = 0.5, .drift_std_ppm = 3}, 1, "boat", Time{0});
  EXPECT_NE(other.error_s(Time{0}), made({.offset_std_s = 0.5, .drift_std_ppm = 3}).error_s(Time{0}));
}

sim::ClockConfig wild() {
  return {.offset_s = 3,
          .drift_ppm = -5000,
          .white_fm = 1e-4,
          .random_walk_fm = 1e-6,
          .flicker_floor = 1e-4,
          .update_s = 0.01};
}

TEST(VehicleClock, NeverGoesBackByItselfAndReportsWhenItShowedAReading) {
  VehicleClock clock = made(wild());
  sim::Random random(1, "test");
  Time before = clock.reading(Time{0});
  for (Time now{0}; now < Time{100'000'000}; now += Time{1 + random.integer_below(20000)}) {
    clock.advance_to(now, {});
    const Time shown = clock.reading(now);
    EXPECT_GE(shown, before);
    before = shown;
    EXPECT_LE(std::abs((clock.true_time(shown) - now).count()), 2);  // both round to a microsecond
  }
}

TEST(VehicleClock, WhatItShowedOrWillShowSoonStays) {
  VehicleClock clock = made(wild());
  std::vector<Time> shown;
  const auto at = [](int i) { return Time{i * 100'000}; };
  for (int i = 0; i <= 600; ++i) {
    clock.advance_to(at(i), {});
    shown.push_back(clock.reading(at(i) + Time{1'900'000}));  // before it is then
  }
  for (int i = 0; i + 19 <= 600; ++i) EXPECT_EQ(clock.reading(at(i + 19)), shown[static_cast<std::size_t>(i)]) << i;
}

TEST(VehicleClock, IsTheSameInEveryRunAndForAnyStep) {
  VehicleClock a = made(wild()), b = made(wild()), other = made(wild(), 2);
  for (int i = 1; i <= 10000; ++i) a.advance_to(Time{1000 * i}, {});
  for (int i = 1; i <= 100; ++i) b.advance_to(Time{100'000 * i}, {});
  other.advance_to(Time{10'000'000}, {});
  EXPECT_EQ(hash_of(a), hash_of(b));
  EXPECT_NE(hash_of(a), hash_of(other));
  EXPECT_EQ(a.error_s(Time{10'000'000}), b.error_s(Time{10'000'000}));
}

TEST(VehicleClock, StaysWithinAYearAndFinite) {
  VehicleClock clock = made({.offset_s = 31557600, .drift_ppm = 1e4, .white_fm = 1e-4, .random_walk_fm = 1e-6});
  const Time ten_years{315'576'000'000'000};
  clock.advance_to(Time{1'000'000}, {});
  EXPECT_TRUE(std::isfinite(clock.error_s(ten_years)));
  EXPECT_LE(clock.error_s(ten_years), 4e7);
}

// Discipline.

/// Fixes once a second, from `from_s` to `to_s`; `bias_s`: of the pulses.
void fixes(VehicleClock& clock, int from_s, int to_s, const sim::DisciplineParams& params, sim::Random& random,
           double bias_s = 0) {
  for (int second = from_s; second <= to_s; ++second) {
    const Time now{1'000'000LL * second};
    clock.advance_to(now, {});
    random.begin_step(second);
    clock.discipline(now, clock.error_s(now) + bias_s + params.pps_std_s * random.gaussian(), params);
  }
}

TEST(ClockDiscipline, TheFirstFixTakesOutALargeErrorForLaterReadingsOnly) {
  VehicleClock clock = made({.offset_s = 5});
  sim::Random random(1, "pps");
  fixes(clock, 10, 10, {.pps_std_s = 0}, random);
  EXPECT_EQ(clock.reading(Time{10'000'000}), Time{15'000'000});
  EXPECT_EQ(clock.reading(Time{10'000'001}), Time{10'000'001});
  EXPECT_TRUE(clock.disciplined(Time{13'000'000}));
  EXPECT_FALSE(clock.disciplined(Time{13'000'001}));
  EXPECT_EQ(clock.since_fix_s(Time{13'000'000}), 3);
}

TEST(ClockDiscipline, TakesOutASmallErrorAsACriticallyDampedLoop) {
  VehicleClock clock = made({.offset_s = 5});
  sim::Random random(1, "pps");
  const sim::DisciplineParams params{.time_constant_s = 20, .pps_std_s = 0};
  fixes(clock, 1, 10, params, random);
  // From now on the pulse comes 100 us late; x is what the loop still sees of it.  Both poles at p = exp(-1 / 20):
  // x_k = x_0 p^(k - 1) (p - k (1 - p)), from the powers of a matrix with a double eigenvalue.
  const double p = std::exp(-1.0 / 20), bias_s = 100e-6;
  for (int k = 0; k < 200; ++k) {
    const Time now{1'000'000LL * (11 + k)};
    EXPECT_NEAR(clock.error_s(now) + bias_s, bias_s * std::pow(p, k - 1) * (p - k * (1 - p)), 1e-10) << k;
    fixes(clock, 11 + k, 11 + k, params, random, bias_s);
  }
}

TEST(ClockDiscipline, LearnsTheDriftFromTwoFixesAndKeepsItWithoutFurtherOnes) {
  VehicleClock clock = made({.offset_s = 1, .drift_ppm = 12});
  sim::Random random(1, "pps");
  fixes(clock, 1, 3, {.pps_std_s = 0}, random);
  // 12 us came in the second between the fixes: the slew takes out 1 - exp(-2 / 20) of them in the next.
  EXPECT_NEAR(clock.rate_error(Time{3'000'000}), -12e-6 * (1 - std::exp(-0.1)), 1e-7);
  fixes(clock, 4, 400, {.pps_std_s = 0}, random);
  clock.advance_to(hour, {});
  EXPECT_NEAR(clock.error_s(hour), 0, 1e-10);
}

TEST(ClockDiscipline, FiltersTheJitterOfThePulseAsItsEquationSays) {
  // x responds to white jitter n of the pulse by -(2 w s + w^2) / (s + w)^2, which gives the variance 5 / 4 w n^2 dt.
  const sim::DisciplineParams params{.time_constant_s = 20, .pps_std_s = 1e-6};
  VehicleClock clock = made({.offset_s = 1});
  sim::Random random(7, "pps");
  double squares = 0;
  int count = 0;
  for (int second = 1; second < 40000; ++second) {
    fixes(clock, second, second, params, random);
    if (second < 400) continue;
    squares += std::pow(clock.error_s(Time{1'000'000LL * (second + 1)}), 2);
    ++count;
  }
  // Some 40000 / 40 independent values: 4 / sqrt(2 * 1000) is 9 %; the loop is discrete, of dt / tau = 5 %.
  EXPECT_NEAR(std::sqrt(squares / count), 1e-6 * std::sqrt(5.0 / 4 / 20), 0.14e-6 * std::sqrt(5.0 / 4 / 20));
}

/// RMS error, over the standard deviation the clock claims, of many clocks that had fixes for `locked_s` and then none
/// for `coast_s`.
double rms_over_claim(sim::ClockConfig config, int locked_s, int coast_s, double pps_std_s) {
  config.offset_s = 0.3;
  double squares = 0, claim_s = 0;
  constexpr int count = 400;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    VehicleClock clock = made(config, seed);
    sim::Random random(seed, "pps");
    fixes(clock, 1, locked_s, {.time_constant_s = 20, .pps_std_s = pps_std_s}, random);
    const Time end{1'000'000LL * (locked_s + coast_s)};
    clock.advance_to(end, {});
    squares += std::pow(clock.error_s(end), 2);
    claim_s = clock.estimated_std_s(end);
  }
  return std::sqrt(squares / count) / claim_s;
}

TEST(ClockDiscipline, CoastingItsErrorGrowsAsItClaims) {
  // 400 clocks: 4 / sqrt(2 * 400) = 14 %; the claim takes a discrete loop for a continuous one: 6 % more.
  EXPECT_NEAR(rms_over_claim({}, 300, 3600, 1e-6), 1, 0.2);
  EXPECT_NEAR(rms_over_claim({.white_fm = 1e-8}, 300, 600, 0), 1, 0.2);
  EXPECT_NEAR(rms_over_claim({.random_walk_fm = 1e-10}, 300, 600, 0), 1, 0.2);
  EXPECT_NEAR(rms_over_claim({.white_fm = 1e-8, .random_walk_fm = 1e-10}, 300, 5, 1e-7), 1, 0.2);
}

TEST(ClockDiscipline, ThePresetsCoastAsTheyClaim) {
  for (const char* preset : {"tcxo", "ocxo", "csac"}) {
    sim::ClockConfig config;
    sim::Diagnostics diagnostics;
    const auto node = sim::parse_config_text(std::string("preset: ") + preset, "test", diagnostics);
    sim::ParamReader in(node, "", diagnostics);
    config.read(in);
    EXPECT_EQ(diagnostics.lines(), std::vector<std::string>{});
    config.temperature_ppm_per_C = 0;
    for (const int coast_s : {10, 600, 3600}) {
      const double ratio = rms_over_claim(config, 300, coast_s, 50e-9);
      // What flicker noise does after a fix is a rule of thumb, and what is left of the drift that two fixes reported
      // is a bound.
      EXPECT_LT(ratio, 1.2) << preset << coast_s;
      EXPECT_GT(ratio, 0.6) << preset << coast_s;
    }
  }
}

TEST(ClockDiscipline, NeverHavingHadAFixItsErrorIsThatOfItsDataSheet) {
  double squares = 0, claim_s = 0;
  constexpr int count = 1000;
  const sim::ClockConfig config{.offset_std_s = 1e-4, .drift_std_ppm = 1, .white_fm = 1e-5, .random_walk_fm = 1e-8};
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    VehicleClock clock = made(config, seed);
    clock.advance_to(Time{300'000'000}, {});
    squares += std::pow(clock.error_s(Time{300'000'000}), 2);
    claim_s = clock.estimated_std_s(Time{300'000'000});
  }
  EXPECT_NEAR(std::sqrt(squares / count) / claim_s, 1, 4 / std::sqrt(2.0 * count));
}

}  // namespace
