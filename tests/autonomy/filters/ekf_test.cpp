// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/filters/ekf.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/base/math.hpp"
#include "sim/random/random.hpp"

namespace {

using autonomy::Ekf;
using autonomy::Increment;
using autonomy::Pose2;
using autonomy::turned;
using autonomy::Vector2d;
using std::numbers::pi;

/// A move along an arc, from its beginning.
Increment arc(double length_m, double turn_rad) {
  if (turn_rad == 0) return {length_m, 0, 0};
  const double radius = length_m / turn_rad;
  return {radius * std::sin(turn_rad), radius * (1 - std::cos(turn_rad)), turn_rad};
}

TEST(Ekf, PredictsAStraight) {
  Ekf ekf({{1, 2}, pi / 6}, 0, 0);
  for (int i = 0; i < 100; ++i) ekf.predict({0.1, 0, 0});
  EXPECT_NEAR(ekf.pose().p_W.x(), 1 + 10 * std::cos(pi / 6), 1e-12);
  EXPECT_NEAR(ekf.pose().p_W.y(), 2 + 10 * std::sin(pi / 6), 1e-12);
}

TEST(Ekf, PredictsAnArc) {
  Ekf ekf({{0, 0}, 0}, 0, 0);
  for (int i = 0; i < 50; ++i) ekf.predict(arc(pi / 50, pi / 100));  // a quarter of a circle of radius 2
  EXPECT_NEAR(ekf.pose().p_W.x(), 2, 1e-12);
  EXPECT_NEAR(ekf.pose().p_W.y(), 2, 1e-12);
  EXPECT_NEAR(ekf.pose().yaw_rad, pi / 2, 1e-12);
}

TEST(Ekf, UncertaintyOfAStraightFollowsTheClosedForm) {
  Ekf::Params params;
  Ekf ekf({{0, 0}, 0}, 0.1, 0, params);
  const double length_m = 10;
  const int steps = 10000;
  for (int i = 0; i < steps; ++i) ekf.predict({length_m / steps, 0, 0});
  const double along = params.along_std_m * params.along_std_m;
  const double across = params.across_std_m * params.across_std_m;
  const double yaw = params.yaw_per_meter_std_rad * params.yaw_per_meter_std_rad;
  // The heading is a random walk over the way; its integral has the variance q L^3 / 3.  Summing in steps
  // instead is off by the order of 1 / steps.
  const double rounding = 10.0 / steps;
  EXPECT_NEAR(ekf.covariance()(0, 0), 0.01 + along * length_m, 1e-9);
  EXPECT_NEAR(ekf.covariance()(1, 1) / (0.01 + across * length_m + yaw * std::pow(length_m, 3) / 3), 1, rounding);
  EXPECT_NEAR(ekf.covariance()(2, 2), yaw * length_m, 1e-9);
}

TEST(Ekf, UncertaintyGrowsWithEveryMove) {
  Ekf ekf({{0, 0}, 0}, 0.1, 0.01);
  double before = ekf.covariance().trace();
  for (int i = 0; i < 200; ++i) {
    ekf.predict(i % 2 == 0 ? arc(0.1, 0.05) : arc(0, 0.1));
    EXPECT_GT(ekf.covariance().trace(), before);
    before = ekf.covariance().trace();
  }
}

TEST(Ekf, StandingStillAddsNoUncertainty) {
  Ekf ekf({{0, 0}, 0}, 0.1, 0.01);
  const Eigen::Matrix3d before = ekf.covariance();
  for (int i = 0; i < 100; ++i) ekf.predict({0, 0, 0});
  EXPECT_EQ(ekf.covariance(), before);
}

TEST(Ekf, GpsPullsByTheRatioOfVariances) {
  Ekf ekf({{0, 0}, 0}, 2, 0.1);
  EXPECT_TRUE(ekf.update_position({1, -1}, 1));  // gain 4 / (4 + 1)
  EXPECT_NEAR(ekf.pose().p_W.x(), 0.8, 1e-12);
  EXPECT_NEAR(ekf.pose().p_W.y(), -0.8, 1e-12);
  EXPECT_NEAR(ekf.covariance()(0, 0), 0.8, 1e-12);  // 1 / (1/4 + 1/1)
  EXPECT_NEAR(ekf.position_std_m(), std::sqrt(0.8), 1e-12);
}

TEST(Ekf, SightingCorrectsThePosition) {
  // It believes to be at the origin and is at (0.5, 0.3), looking north; the other stands at (0, 10).
  Ekf ekf({{0, 0}, pi / 2}, 1, 1e-6);
  const Vector2d seen_B = turned(Vector2d(0, 10) - Vector2d(0.5, 0.3), -pi / 2);
  EXPECT_TRUE(ekf.update_relative(seen_B, 1e-4, {0, 10}, 1e-4));
  EXPECT_NEAR(ekf.pose().p_W.x(), 0.5, 1e-4);
  EXPECT_NEAR(ekf.pose().p_W.y(), 0.3, 1e-4);
}

TEST(Ekf, SightingCorrectsTheHeading) {
  // The heading is wrong by 0.1 rad; what stands 10 m ahead is seen 1 m to the right.
  Ekf ekf({{0, 0}, 0}, 1e-6, 0.2);
  EXPECT_TRUE(ekf.update_relative(turned({10, 0}, -0.1), 0.05, {10, 0}, 1e-6));
  // The filter takes the sine for the angle; its gain is 2^2 / (2^2 + 0.05^2).
  EXPECT_NEAR(ekf.pose().yaw_rad, std::sin(0.1) * 4 / 4.0025, 1e-6);
}

TEST(Ekf, GateRefusesAnOutlier) {
  Ekf ekf({{0, 0}, 0}, 0.1, 0.01);
  // Variance 0.01 + 0.01; the gate lies at sqrt(13.82 * 0.02) = 0.526 m.
  EXPECT_TRUE(Ekf(ekf).update_position({0.52, 0}, 0.1));
  EXPECT_FALSE(ekf.update_position({0.53, 0}, 0.1));
  EXPECT_FALSE(ekf.update_position({std::numeric_limits<double>::quiet_NaN(), 0}, 0.1));
  EXPECT_EQ(ekf.pose().p_W, Vector2d(0, 0));
  EXPECT_DOUBLE_EQ(ekf.covariance()(0, 0), 0.01);
}

TEST(Ekf, FindsBackWhenItWasSureAndWrong) {
  Ekf ekf({{0, 0}, 0}, 0.1, 0.01);  // in truth it was carried to (4, 3)
  int refused = 0;
  while (refused < 100 && !ekf.update_position({4, 3}, 0.5)) ++refused;
  EXPECT_EQ(refused, Ekf::Params().max_refusals);
  EXPECT_LT((ekf.pose().p_W - Vector2d(4, 3)).norm(), 0.1);
}

/// One run of a rover whose errors are as the filter believes; normalized error squared at its end.
double nees_of_run(std::uint64_t seed) {
  const Ekf::Params params;
  sim::Random random(seed, "nees");
  random.begin_step(1);
  Pose2 truth{{0, 0}, 0};
  const double start_std_m = 0.2;
  const double start_std_rad = 0.05;
  Ekf ekf({{start_std_m * random.gaussian(), start_std_m * random.gaussian()}, start_std_rad * random.gaussian()},
          start_std_m, start_std_rad, params);
  const Vector2d neighbor_W(15, 5);
  for (int i = 1; i <= 600; ++i) {
    const Increment reported = arc(0.05, i % 200 < 100 ? 0.01 : -0.005);
    const double distance = std::hypot(reported.forward_m, reported.left_m);
    const double yaw_std = std::sqrt(std::pow(params.yaw_per_turn_std_rad, 2) * std::abs(reported.turn_rad) +
                                     std::pow(params.yaw_per_meter_std_rad, 2) * distance);
    const Vector2d moved_B(reported.forward_m + params.along_std_m * std::sqrt(distance) * random.gaussian(),
                           reported.left_m + params.across_std_m * std::sqrt(distance) * random.gaussian());
    truth.p_W += turned(moved_B, truth.yaw_rad);
    truth.yaw_rad += reported.turn_rad + yaw_std * random.gaussian();
    ekf.predict(reported);
    if (i % 20 != 0) continue;
    const Vector2d noise(0.15 * random.gaussian(), 0.15 * random.gaussian());
    const Vector2d reported_W = neighbor_W + 0.5 * Vector2d(random.gaussian(), random.gaussian());
    ekf.update_relative(turned(neighbor_W - truth.p_W, -truth.yaw_rad) + noise, 0.15, reported_W, 0.5);
  }
  Eigen::Vector3d error;
  error << truth.p_W - ekf.pose().p_W, sim::wrap_angle(truth.yaw_rad - ekf.pose().yaw_rad);
  return error.dot(ekf.covariance().inverse() * error);
}

TEST(Ekf, IsAsWrongAsItSays) {
  // The sum over n runs is chi-square with 3 n degrees of freedom: mean 3 n, variance 6 n.  3.3 standard
  // deviations hold 99.9 % of all seeds.
  const int runs = 200;
  double sum = 0;
  for (int seed = 1; seed <= runs; ++seed) sum += nees_of_run(static_cast<std::uint64_t>(seed));
  EXPECT_NEAR(sum / runs, 3.0, 3.3 * std::sqrt(6.0 / runs));
}

}  // namespace
