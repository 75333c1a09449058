// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/filters/marine_ekf.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/random/random.hpp"
#include "tests/autonomy/second.hpp"

namespace {

using autonomy::MarineEkf;
using autonomy::turned;
using autonomy::Vector2d;
using Outcome = MarineEkf::Outcome;

using test::second;

MarineEkf::Range range_to(const Vector2d& p_W, double range_m, std::int64_t utime, double std_m = 1) {
  MarineEkf::Range range;
  range.utime = utime;
  range.range_m = range_m;
  range.std_m = std_m;
  range.p_WS.head<2>() = p_W;
  return range;
}

MarineEkf::Params without_noise(int states) {
  MarineEkf::Params params;
  params.states = states;
  params.heading_noise_radprtHz = params.speed_noise_mpsprtHz = 0;
  params.heading_bias_walk_rad = params.speed_scale_walk = params.range_bias_walk_m = params.range_drift_walk_mps = 0;
  return params;
}

TEST(MarineEkf, PredictsAStraight) {
  MarineEkf ekf(0, {10, 20}, 1, {});
  for (int i = 1; i <= 100; ++i) ekf.predict(i * second / 10, {1.5, -0.5});
  EXPECT_NEAR(ekf.position().x(), 25, 1e-9);
  EXPECT_NEAR(ekf.position().y(), 15, 1e-9);
}

TEST(MarineEkf, HeadingBiasMakesThePositionUnsureAcrossTheWay) {
  MarineEkf::Params params = without_noise(4);
  params.heading_bias_std_rad = 0.05;
  params.speed_scale_std = 0.02;
  MarineEkf ekf(0, {0, 0}, 0, params);
  for (int i = 1; i <= 1000; ++i) ekf.predict(i * second, {0, 2});
  // After a straight of length L: L times the bias across, L times the scale error along.
  EXPECT_NEAR(std::sqrt(ekf.position_covariance()(0, 0)), 2000 * 0.05, 1e-6);
  EXPECT_NEAR(std::sqrt(ekf.position_covariance()(1, 1)), 2000 * 0.02, 1e-6);
}

TEST(MarineEkf, RangeMovesItAlongTheLineToTheBeaconOnly) {
  MarineEkf ekf(0, {100, 0}, 3, without_noise(2));
  ASSERT_EQ(ekf.update_range(range_to({0, 0}, 104, 0, 4)), Outcome::accepted);
  // Scalar Kalman gain 9 / (9 + 16 + bend), with a bend of 3 (9 / 200)^2.
  const double variance = 16 + 3 * std::pow(9.0 / 200, 2);
  EXPECT_NEAR(ekf.position().x(), 100 + 4 * 9 / (9 + variance), 1e-12);
  EXPECT_NEAR(ekf.position().y(), 0, 1e-12);
  EXPECT_NEAR(ekf.position_covariance()(0, 0), 9 * variance / (9 + variance), 1e-9);
  EXPECT_NEAR(ekf.position_covariance()(1, 1), 9, 1e-12);
}

TEST(MarineEkf, ErrorOfTheBeaconCountsAlongTheLineOnly) {
  for (const bool along : {true, false}) {
    MarineEkf ekf(0, {100, 0}, 3, without_noise(2));
    MarineEkf::Range range = range_to({0, 0}, 104, 0, 4);
    range.beacon_covariance.diagonal() << (along ? 25 : 0), (along ? 0 : 25);
    ekf.update_range(range);
    const double variance = 16 + (along ? 25 : 0) + 3 * std::pow(9.0 / 200, 2);
    EXPECT_NEAR(ekf.position_covariance()(0, 0), 9 * variance / (9 + variance), 1e-9);
  }
}

TEST(MarineEkf, SlantRangeUsesTheKnownDepths) {
  MarineEkf ekf(0, {40, 0}, 3, without_noise(2));
  MarineEkf::Range range = range_to({0, 0}, 50, 0);
  range.p_WS.z() = -1;
  range.own_z_m = -31;  // 3, 4, 5
  ekf.update_range(range);
  EXPECT_NEAR(ekf.position().x(), 40, 1e-9);
  EXPECT_LT(ekf.position_covariance()(0, 0), 3);
}

TEST(MarineEkf, RangeThatIsTenSecondsOldBelongsToWhereItWas) {
  MarineEkf ekf(0, {100, 0}, 3, without_noise(4));
  for (int i = 1; i <= 20; ++i) ekf.predict(i * second, {2, 1});
  // Half a second between two predictions, too: at 10.5 s it was at 121, 10.5.
  EXPECT_NEAR(ekf.position_at(10'500'000).x(), 121, 1e-9);
  EXPECT_NEAR(ekf.position_at(21 * second).y(), 21, 1e-9);
  ASSERT_EQ(ekf.update_range(range_to({0, 0}, std::hypot(121, 10.5), 10'500'000)), Outcome::accepted);
  EXPECT_NEAR(ekf.position().x(), 140, 1e-9);
  EXPECT_NEAR(ekf.position().y(), 20, 1e-9);
}

TEST(MarineEkf, RangeOfLongAgoIsNotUsed) {
  MarineEkf ekf(0, {100, 0}, 3, {});
  for (int i = 1; i <= 200; ++i) ekf.predict(i * second, {2, 1});
  EXPECT_EQ(ekf.update_range(range_to({0, 0}, 100, 100 * second)), Outcome::too_old);
  EXPECT_EQ(ekf.update_position(-second, {0, 0}, 1), Outcome::too_old);
}

TEST(MarineEkf, WhatIsNoNumberIsRefusedForEver) {
  MarineEkf ekf(0, {100, 0}, 1, {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 20; ++i) EXPECT_EQ(ekf.update_range(range_to({0, 0}, nan, 0)), Outcome::refused);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(ekf.update_position(0, {nan, 0}, 1), Outcome::refused);
  ekf.predict(second, {nan, 1});
  EXPECT_TRUE(ekf.state().allFinite());
  EXPECT_TRUE(ekf.covariance().allFinite());
  EXPECT_EQ(ekf.inflated(), 0);
}

TEST(MarineEkf, NumberOfStatesIsChecked) {
  for (const int states : {-1, 0, 1, 3, 7}) {
    MarineEkf::Params params;
    params.states = states;
    EXPECT_THROW(MarineEkf(0, {0, 0}, 1, params), std::invalid_argument) << states;
  }
}

TEST(MarineEkf, StatesThatAreNotEstimatedStayZero) {
  for (const int states : {2, 4, 5}) {
    MarineEkf::Params params;
    params.states = states;
    MarineEkf ekf(0, {100, 0}, 3, params);
    for (int i = 1; i <= 50; ++i) {
      ekf.predict(i * second, {1, 1});
      ekf.update_range(range_to({0, 0}, std::hypot(100 + i, i) + 2, i * second));
    }
    EXPECT_EQ(ekf.state().tail(6 - states).norm(), 0) << states;
    EXPECT_EQ(ekf.covariance().bottomRows(6 - states).norm(), 0) << states;
  }
}

/// The lawn of the published simulations: legs of 400 m, 40 m apart, at 1.5 m/s for an hour.
struct Lawn {
  static Vector2d velocity(double distance_m) {
    constexpr double leg_m = 400;
    constexpr double step_m = 40;
    const double in_pair_m = std::fmod(distance_m, 2 * (leg_m + step_m));
    if (in_pair_m < leg_m) return {1.5, 0};
    if (in_pair_m < leg_m + step_m) return {0, 1.5};
    if (in_pair_m < 2 * leg_m + step_m) return {-1.5, 0};
    return {0, 1.5};
  }
};

struct Sea {
  double heading_bias_std_rad = 3 * std::numbers::pi / 180;
  double speed_scale_std = 0.03;
  double range_std_m = 3;
  double gps_std_m = 1;
  double heading_noise_rad = 2 * std::numbers::pi / 180;  // each second
  bool straight = false;
  int duration_s = 3600;
  int settle_s = 300;         ///< not counted for the filter
  double clock_offset_m = 0;  ///< one sigma
  double clock_drift_mps = 0;
};

struct Errors {
  double rms_m = 0;
  double max_m = 0;
  double end_m = 0;
  double mean_nees = 0;  ///< of the position, 2 degrees
  double mean_nis = 0;
  double clock_end_m = 0;
};

struct Trial {
  Errors filter;
  Errors dead_reckoning;
};

void add(Errors& errors, const Vector2d& e) {
  errors.rms_m += e.squaredNorm();
  errors.max_m = std::max(errors.max_m, e.norm());
  errors.end_m = e.norm();
}

Trial simulate(const Sea& sea, const MarineEkf::Params& params, std::uint64_t seed) {
  sim::Random random(seed, "marine_ekf_test");
  random.begin_step(0);
  const double bias = sea.heading_bias_std_rad * random.gaussian();
  const double scale = sea.speed_scale_std * random.gaussian();
  double clock_m = sea.clock_offset_m * random.gaussian();
  const double drift_mps = sea.clock_drift_mps * random.gaussian();
  const std::array<Vector2d, 2> beacons = {Vector2d(-100, 100), Vector2d(500, 300)};
  Vector2d p_W(0, 0);
  Vector2d reckoned_W(0, 0);
  MarineEkf ekf(0, p_W + sea.gps_std_m * Vector2d(random.gaussian(), random.gaussian()), sea.gps_std_m, params);
  Trial run;
  int ranges = 0;
  for (int t = 1; t <= sea.duration_s; ++t) {
    random.begin_step(t);
    const Vector2d v_W = sea.straight ? Vector2d(1.5, 0) : Lawn::velocity(1.5 * (t - 1));
    p_W += v_W;
    clock_m += drift_mps;
    // True heading = measured + bias, true speed = (1 + scale) measured; the noise is on top.
    const Vector2d measured_W = turned(v_W / (1 + scale), -bias + sea.heading_noise_rad * random.gaussian());
    reckoned_W += measured_W;
    ekf.predict(t * second, measured_W);
    if (t % 10 == 0) {
      const Vector2d& beacon_W = beacons[static_cast<std::size_t>(t / 10 % 2)];
      MarineEkf::Range range = range_to(beacon_W + sea.gps_std_m * Vector2d(random.gaussian(), random.gaussian()),
                                        (p_W - beacon_W).norm() + clock_m + sea.range_std_m * random.gaussian(),
                                        t * second, sea.range_std_m);
      range.beacon_covariance = sea.gps_std_m * sea.gps_std_m * Eigen::Matrix2d::Identity();
      ekf.update_range(range);
      run.filter.mean_nis += ekf.last_nis();
      ++ranges;
    }
    const Vector2d e = ekf.position() - p_W;
    if (t > sea.settle_s) add(run.filter, e);
    add(run.dead_reckoning, reckoned_W - p_W);
    run.filter.mean_nees += e.dot(ekf.position_covariance().inverse() * e);
  }
  run.filter.rms_m = std::sqrt(run.filter.rms_m / (sea.duration_s - sea.settle_s));
  run.dead_reckoning.rms_m = std::sqrt(run.dead_reckoning.rms_m / sea.duration_s);
  run.filter.mean_nees /= sea.duration_s;
  run.filter.mean_nis /= ranges;
  run.filter.clock_end_m = std::abs(ekf.range_bias_m() - clock_m);
  return run;
}

struct Study {
  std::vector<Trial> runs;
  template <class Get>
  double percentile(double part, Get get) const {
    std::vector<double> values;
    for (const Trial& run : runs) values.push_back(get(run));
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1) + 0.5)];
  }
  template <class Get>
  double mean(Get get) const {
    double sum = 0;
    for (const Trial& run : runs) sum += get(run);
    return sum / static_cast<double>(runs.size());
  }
};

Study study(const Sea& sea, int states) {
  MarineEkf::Params params;
  params.states = states;
  params.heading_bias_std_rad = sea.heading_bias_std_rad;
  params.speed_scale_std = sea.speed_scale_std;
  params.heading_noise_radprtHz = sea.heading_noise_rad;
  params.speed_noise_mpsprtHz = 0.001;
  params.range_bias_std_m = std::max(sea.clock_offset_m, 0.1);
  params.range_drift_std_mps = std::max(sea.clock_drift_mps, 1e-5);
  Study all;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) all.runs.push_back(simulate(sea, params, seed));
  return all;
}

double filter_rms(const Trial& run) {
  return run.filter.rms_m;
}
double filter_max(const Trial& run) {
  return run.filter.max_m;
}
double reckoned_end(const Trial& run) {
  return run.dead_reckoning.end_m;
}
double reckoned_max(const Trial& run) {
  return run.dead_reckoning.max_m;
}
double nees(const Trial& run) {
  return run.filter.mean_nees;
}
double nis(const Trial& run) {
  return run.filter.mean_nis;
}

Sea five_degrees() {
  Sea sea;
  sea.heading_bias_std_rad = 5 * std::numbers::pi / 180;
  sea.speed_scale_std = 0.05;
  return sea;
}

struct Band {
  double low;
  double high;
};

#define EXPECT_IN(value, band)  \
  EXPECT_GE(value, (band).low); \
  EXPECT_LE(value, (band).high)

struct Envelope {
  Sea sea;
  Band reckoned_end_m;
  Band reckoned_max_m;
  Band two_rms_m;
  Band four_rms_m;
};

// Bands of 100 runs of such a lawn (range error 3 m each 10 s from two beacons in turn, GPS 1 m, heading noise 2
// degrees), computed apart from this filter for biases of 3 degrees and 3 %, and of 5 degrees and 5 %.
TEST(MarineEkf, LawnIsWithinTheEnvelope) {
  for (const Envelope& expected : {Envelope{Sea(), {22, 25}, {28, 30}, {4.7, 5.5}, {1.3, 1.5}},
                                   Envelope{five_degrees(), {37, 45}, {45, 55}, {6.0, 6.7}, {1.3, 1.5}}}) {
    const Study two = study(expected.sea, 2);
    EXPECT_IN(two.percentile(0.5, reckoned_end), expected.reckoned_end_m);
    EXPECT_IN(two.percentile(0.5, reckoned_max), expected.reckoned_max_m);
    EXPECT_IN(two.percentile(0.5, filter_rms), expected.two_rms_m);
    const Study four = study(expected.sea, 4);
    EXPECT_IN(four.percentile(0.5, filter_rms), expected.four_rms_m);
    EXPECT_IN(four.percentile(0.95, filter_max), (Band{3.6, 4.5}));
  }
}

TEST(MarineEkf, IsAsUnsureAsItIsWrong) {
  const Study four = study(Sea(), 4);
  // Chi-square with 2 degrees has a mean of 2, with one of 1.  One run's mean NEES scatters by 0.8 or so: errors last
  // for minutes; one run's mean NIS of 360 ranges by 0.075.  Four sigma of the mean of 100.
  EXPECT_NEAR(four.mean(nees), 2, 0.32);
  EXPECT_NEAR(four.mean(nis), 1, 0.03);
}

TEST(MarineEkf, OnAStraightTheHeadingBiasCountsInFull) {
  Sea sea = five_degrees();
  sea.straight = true;
  sea.duration_s = 1333;  // 2 km
  const Study four = study(sea, 4);
  // 5 degrees of the way across, 5 % along; the root of the mean square of 100 runs scatters by 8 %.
  const double mean_square_m2 = four.mean([](const Trial& trial) { return std::pow(trial.dead_reckoning.end_m, 2); });
  const double expected_m = 2000 * std::hypot(sea.heading_bias_std_rad, sea.speed_scale_std);
  EXPECT_NEAR(std::sqrt(mean_square_m2), expected_m, 0.24 * expected_m);
  EXPECT_LT(four.percentile(0.95, filter_rms), 5);
  EXPECT_NEAR(four.mean(nees), 2, 0.32);
}

TEST(MarineEkf, DriftOfTheClockNeedsItsStates) {
  Sea sea;
  sea.clock_offset_m = 30;        // 20 ms
  sea.clock_drift_mps = 1500e-6;  // 1 ppm
  const Study six = study(sea, 6);
  EXPECT_LT(six.percentile(0.95, filter_rms), 3.5);
  EXPECT_LT(six.percentile(0.95, [](const Trial& run) { return run.filter.clock_end_m; }), 3);
  EXPECT_NEAR(six.mean(nees), 2, 0.32);
  EXPECT_GT(study(sea, 4).percentile(0.5, filter_rms), 15);
}

}  // namespace
