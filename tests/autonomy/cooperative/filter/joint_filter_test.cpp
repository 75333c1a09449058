// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/filter/joint_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "autonomy/filters/chi_square.hpp"

namespace {

using navigation::DeviceErrors;
using navigation::JointFilter;
using navigation::Matrix2;
using navigation::Position;
using navigation::Time;
using navigation::Vector2;

constexpr Time second = 1'000'000;

TEST(JointFilter, HeadingBiasAndScaleMakeThePositionUnsureAcrossAndAlong) {
  JointFilter filter;
  const DeviceErrors errors{.heading_bias_rad = 0.05, .speed_scale = 0.02};
  const int auv = filter.add(errors, 0, {0, 0}, 1e-9);
  for (int i = 1; i <= 1000; ++i) filter.move(auv, i * second, {0, 2}, Matrix2::Zero());
  // After a straight of length L: L times the bias across, L times the scale error along.
  EXPECT_NEAR(std::sqrt(filter.covariance(auv)(0, 0)), 2000 * 0.05, 1e-6);
  EXPECT_NEAR(std::sqrt(filter.covariance(auv)(1, 1)), 2000 * 0.02, 1e-6);
}

TEST(JointFilter, NoiseIsInTheAxesOfTheCorrectedHeading) {
  for (const DeviceErrors& errors : {DeviceErrors{.heading_bias_rad = 2}, DeviceErrors{.slow_heading_rad = 2}}) {
    JointFilter filter;
    const int robot = filter.add(errors, 0, {0, 0}, 1e-9);
    // Its odometry says east; a measurement shows that it drives north.
    Eigen::VectorXd H = Eigen::VectorXd::Zero(3);
    H[2] = 1;
    filter.update(H, std::numbers::pi / 2, 1e-12);
    filter.move(robot, second, {0.1, 0}, Vector2(0.04, 0.01).asDiagonal());
    EXPECT_NEAR(filter.position(robot).x(), 0, 1e-9);
    EXPECT_NEAR(filter.position(robot).y(), 0.1, 1e-9);
    // What is along the track is to the north now.  1e-12 rad^2 of the heading are 1e-14 m^2.
    EXPECT_NEAR(filter.covariance(robot)(1, 1), 0.04, 1e-9);
    EXPECT_NEAR(filter.covariance(robot)(0, 0), 0.01, 1e-9);
    EXPECT_NEAR(filter.covariance(robot)(0, 1), 0, 1e-9);
  }
}

TEST(JointFilter, ASlowHeadingErrorAddsAsAGaussMarkovProcess) {
  JointFilter filter;
  const DeviceErrors errors{.slow_heading_rad = 0.02, .slow_heading_time_s = 20};
  const int auv = filter.add(errors, 0, {0, 0}, 1e-9);
  for (int i = 1; i <= 2000; ++i) filter.move(auv, i * second / 10, {1, 0}, Matrix2::Zero());
  // Variance of the integral of a Gauss-Markov process: 2 s^2 T (t - T (1 - exp(-t / T))); steps of 0.1 s change it by
  // less than 1 %.
  const double t = 200, T = 20;
  const double variance = 2 * 0.02 * 0.02 * T * (t - T * (1 - std::exp(-t / T)));
  EXPECT_NEAR(filter.covariance(auv)(1, 1), variance, 0.01 * variance);
}

TEST(JointFilter, ARangeBetweenTwoPartsIsSharedByTheirCovariances) {
  JointFilter filter;
  const int a = filter.add(Position{{0, 0}, 1 * Matrix2::Identity()});
  const int b = filter.add(Position{{1e5, 0}, 4 * Matrix2::Identity()});
  // S = 1 + 4 + 5 = 10; the innovation is 10 m: a moves by -1 m, b by 4 m.  Points of equal range are a line at 100 km.
  filter.range(a, b, 0, 1e5 + 10, std::sqrt(5));
  EXPECT_NEAR(filter.position(a).x(), -1, 1e-6);
  EXPECT_NEAR(filter.position(b).x(), 1e5 + 4, 1e-5);
  EXPECT_NEAR(filter.covariance(a)(0, 0), 1 - 1.0 / 10, 1e-6);
  EXPECT_NEAR(filter.covariance(b)(0, 0), 4 - 16.0 / 10, 1e-6);
  EXPECT_NEAR(filter.P()(filter.offset(a), filter.offset(b)), 4.0 / 10, 1e-6);
  EXPECT_NEAR(filter.covariance(a)(1, 1), 1, 1e-9);
}

TEST(JointFilter, ACopyStaysWhereTheVehicleWas) {
  JointFilter filter;
  const int auv = filter.add(DeviceErrors{}, 0, {0, 0}, 1);
  const int then = filter.copy(auv);
  filter.move(auv, 10 * second, {1, 0}, 0.1 * Matrix2::Identity());
  EXPECT_EQ(filter.position(then), Vector2(0, 0));
  // A fix of the vehicle tells as much of where it was: cov(then, now) = 1, var(now) = 1 + 0.1 * 10 = 2.
  filter.fix(auv, {12, 0}, 1);
  EXPECT_NEAR(filter.position(then).x(), 1.0 / 3 * 2, 1e-12);
  EXPECT_NEAR(filter.covariance(then)(0, 0), 1 - 1.0 / 3, 1e-12);
}

TEST(JointFilter, RemovingACopyLeavesTheOthers) {
  JointFilter filter;
  const int auv = filter.add(DeviceErrors{.clock_s = 0.001}, 0, {1, 2}, 1);
  const int first = filter.copy(auv);
  filter.move(auv, second, {1, 0}, Matrix2::Identity());
  const int later = filter.copy(auv);
  filter.remove(first);
  EXPECT_EQ(filter.size(), 6);
  EXPECT_EQ(filter.position(later), Vector2(2, 2));
  EXPECT_EQ(filter.position(auv), Vector2(2, 2));
  EXPECT_EQ(filter.copy(auv), first);  // its number is free
}

TEST(JointFilter, ClocksOfBothEndsAreInARange) {
  JointFilter filter(1500);
  const int a = filter.add(DeviceErrors{.clock_s = 1e-3}, 0, {0, 0}, 1e-6);
  const int b = filter.add(DeviceErrors{.clock_s = 1e-3}, 0, {1000, 0}, 1e-6);
  // The own clock is ahead by as much as that of the other is behind: each has half of 3 m.
  filter.range(a, b, 0, 1003, 1e-3);
  EXPECT_NEAR(filter.x()[2], 1.5, 1e-3);
  EXPECT_NEAR(filter.x()[filter.offset(b) + 2], -1.5, 1e-3);
  EXPECT_NEAR(filter.now(a, 0).clock_error_s, 1.5 / 1500, 1e-6);
}

TEST(JointFilter, ARangeBeyondTheGateIsRefused) {
  JointFilter filter(1500, autonomy::chi_square_999_1);
  const int auv = filter.add(DeviceErrors{}, 0, {0, 0}, 1);
  const Position beacon{{-5e4, 0}, 1e-4 * Matrix2::Identity()};
  EXPECT_EQ(filter.range(auv, beacon, 0, 5e4 + 5, 1), JointFilter::Outcome::refused);  // 25 / 2
  EXPECT_EQ(filter.range(auv, beacon, 0, 5e4 + 4, 1), JointFilter::Outcome::used);     // 16 / 2
}

TEST(JointFilter, ADirectionAndADistanceAreAPosition) {
  JointFilter filter;
  const int rover = filter.add(DeviceErrors{}, 0, {10.02, 19.99}, 1);
  navigation::Relative seen;
  seen.range_m = 5;
  seen.bearing_rad = std::atan2(4, 3);
  const Position other{{13, 24}, 1e-8 * Matrix2::Identity()};
  seen.range_std_m = seen.bearing_std_rad = 1e-4;
  filter.see(filter.relative_row(rover, other, seen));
  EXPECT_NEAR(filter.position(rover).x(), 10, 1e-6);
  EXPECT_NEAR(filter.position(rover).y(), 20, 1e-6);
}

TEST(JointFilter, ASightOfANearOneIsAsGoodAsTheSensorHoweverUnsureThePositionIs) {
  JointFilter filter(1500, autonomy::chi_square_999_1);
  const int rover = filter.add(DeviceErrors{}, 0, {2, 1}, 5);
  navigation::Relative seen;
  seen.range_m = 2;
  seen.range_std_m = 0.1;
  seen.bearing_std_rad = 0.05;
  // It is at (0, 0), 2 m west of the other one, but is believed to be 1 m north of it.
  const Position other{{2, 0}, 1e-8 * Matrix2::Identity()};
  EXPECT_EQ(filter.see(filter.relative_row(rover, other, seen)), JointFilter::Outcome::used);
  // 5 m against 0.1 m: of the error of (2, 1) m there remains (0.1 / 5)^2.  Terms of second order are s / 2r = 3 mm.
  EXPECT_NEAR(filter.position(rover).x(), 0, 2e-3);
  EXPECT_NEAR(filter.position(rover).y(), 0, 2e-3);
  EXPECT_NEAR(std::sqrt(filter.covariance(rover)(0, 0)), 0.1, 1e-3);
  EXPECT_NEAR(std::sqrt(filter.covariance(rover)(1, 1)), 0.05 * 2, 1e-3);
}

TEST(JointFilter, ABearingByAnotherVehicleSaysNothingOfTheOwnHeading) {
  JointFilter filter;
  const DeviceErrors errors{.heading_bias_rad = 0.1};
  const int own = filter.add(errors, 0, {0, 0}, 1), other = filter.add(errors, 0, {100, 0}, 1e-3);
  navigation::Relative seen;
  seen.range_m = 100;
  seen.by_other = true;
  const JointFilter::RelativeRow row = filter.relative_row(own, other, seen);
  EXPECT_EQ(row.H(1, filter.offset(own) + 2), 0);
  EXPECT_EQ(row.H(1, filter.offset(other) + 2), -1);
  // Of a position outside of the filter: across, 0.02 rad at 100 m against 1 m.
  const Position craft{{100, 0}, 1e-9 * Matrix2::Identity()};
  seen.range_std_m = 0.01;
  seen.bearing_std_rad = 0.02;
  filter.see(filter.relative_row(own, craft, seen));
  EXPECT_NEAR(filter.covariance(own)(1, 1), 1 - 1 / (1 + 4.0), 1e-3);
  EXPECT_NEAR(filter.P()(filter.offset(own) + 2, filter.offset(own) + 2), 0.01, 1e-12);
}

TEST(JointFilter, ASightOfAnotherPlaceIsRefusedHoweverOftenItComes) {
  JointFilter filter(1500, autonomy::chi_square_999_1);
  filter.add(DeviceErrors{}, 0, {0, 0}, 0.1);
  const Position other{{20, 0}, 1e-4 * Matrix2::Identity()};
  navigation::Relative seen;
  seen.range_std_m = 0.1;
  seen.bearing_std_rad = 0.01;
  const auto see = [&](double range_m) {
    seen.range_m = range_m;
    return filter.see(filter.relative_row(0, other, seen));
  };
  // Cameras that read a wrong code read it in frame after frame.
  for (int i = 0; i < 50; ++i) EXPECT_EQ(see(10), JointFilter::Outcome::refused);
  EXPECT_EQ(filter.position(0), Vector2(0, 0));
  EXPECT_EQ(filter.covariance(0)(0, 0), 0.1 * 0.1);
  EXPECT_EQ(see(20), JointFilter::Outcome::used);
}

TEST(JointFilter, FiveRefusedFixesInARowOpenThePosition) {
  JointFilter filter(1500, autonomy::chi_square_999_1);
  const int auv = filter.add(DeviceErrors{}, 0, {0, 0}, 1);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(filter.fix(auv, {100, 0}, 1), JointFilter::Outcome::refused);
  EXPECT_EQ(filter.fix(auv, {100, 0}, 1), JointFilter::Outcome::used);
  EXPECT_NEAR(filter.position(auv).x(), 100, 0.1);
}

TEST(JointFilter, CovarianceStaysPositiveOverManyUpdates) {
  JointFilter filter;
  const DeviceErrors errors{.heading_bias_rad = 0.05, .speed_scale = 0.03, .clock_s = 0.005, .clock_drift = 1e-6};
  const int auv = filter.add(errors, 0, {0, 0}, 1);
  for (int i = 1; i <= 3000; ++i) {
    const double angle = 0.01 * i;
    filter.move(auv, i * second, {std::cos(angle), std::sin(angle)}, 1e-6 * Matrix2::Identity());
    filter.range(auv, Position{{300, 100.0 * (i % 3)}, 1e-4 * Matrix2::Identity()}, 5, 300, 1e-3);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(filter.P());
  EXPECT_GT(solver.eigenvalues().minCoeff(), 0);
}

}  // namespace
