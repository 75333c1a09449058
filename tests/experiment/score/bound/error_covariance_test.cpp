// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/bound/error_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using experiment::ErrorCovariance;

MatrixXd scalar_matrix(double value) {
  return MatrixXd::Constant(1, 1, value);
}

TEST(ErrorCovariance, IsTheInverseOfTheInformationMatrix) {
  Matrix2d F, Q;
  F << 1, 0.5, 0, 0.95;
  Q << 0.3, 0.1, 0.1, 0.2;
  Eigen::RowVector2d H(1, 0.4);
  constexpr double R = 0.7;
  Matrix2d J = Matrix2d::Identity() / 4;
  ErrorCovariance covariance(J.inverse());
  for (int step = 0; step < 50; ++step) {
    // Tichavsky, Muravchik and Nehorai 1998, equations 21 and 34 to 36.
    const Matrix2d D11 = F.transpose() * Q.inverse() * F;
    const Matrix2d D12 = -F.transpose() * Q.inverse();
    const Matrix2d D22 = Q.inverse() + H.transpose() * H / R;
    J = (D22 - D12.transpose() * (J + D11).inverse() * D12).eval();
    covariance.predict(0, F, Q);
    covariance.update(H, scalar_matrix(R));
    EXPECT_NEAR((covariance.matrix() - J.inverse()).cwiseAbs().maxCoeff(), 0, 1e-10);
  }
}

TEST(ErrorCovariance, OfAStaticPositionIsThatOfItsRanges) {
  ErrorCovariance covariance(Matrix2d(100 * Matrix2d::Identity()));
  Matrix2d J = Matrix2d::Identity() / 100;
  constexpr double R = 0.25;
  for (int i = 0; i < 12; ++i) {
    const Eigen::RowVector2d u(std::cos(0.3 * i), std::sin(0.3 * i));
    covariance.update(u, scalar_matrix(R));
    J += u.transpose() * u / R;
  }
  EXPECT_NEAR((covariance.matrix() - J.inverse()).cwiseAbs().maxCoeff(), 0, 1e-10);
}

TEST(ErrorCovariance, OfARandomWalkWithFixesBecomesStationary) {
  constexpr double q = 0.09, r = 1;
  ErrorCovariance covariance(scalar_matrix(100));
  for (int step = 0; step < 200; ++step) {
    covariance.predict(0, scalar_matrix(1), scalar_matrix(q));
    covariance.update(scalar_matrix(1), scalar_matrix(r));
  }
  // p = (p + q) r / (p + q + r), so p^2 + q p - q r = 0.
  EXPECT_NEAR(covariance.matrix()(0, 0), (-q + std::sqrt(q * q + 4 * q * r)) / 2, 1e-12);
}

TEST(ErrorCovariance, IsReachedByTheOptimalFilterOfALinearSystem) {
  constexpr double q = 0.09, r = 1;
  constexpr int steps = 20, runs = 4000;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  ErrorCovariance covariance(scalar_matrix(4));
  std::vector<double> gains;
  double bound = 0;
  for (int step = 0; step < steps; ++step) {
    covariance.predict(0, scalar_matrix(1), scalar_matrix(q));
    const double p = covariance.matrix()(0, 0);
    gains.push_back(p / (p + r));
    covariance.update(scalar_matrix(1), scalar_matrix(r));
    bound += covariance.matrix()(0, 0);
  }
  double squares = 0;
  for (int run = 0; run < runs; ++run) {
    double truth = 2 * normal(random), estimate = 0;
    for (const double gain : gains) {
      truth += std::sqrt(q) * normal(random);
      estimate += gain * (truth + std::sqrt(r) * normal(random) - estimate);
      squares += (estimate - truth) * (estimate - truth);
    }
  }
  // The relative standard error of a mean square of independent runs is at most sqrt(2 / runs); four of them.
  EXPECT_NEAR(squares / runs / bound, 1, 4 * std::sqrt(2.0 / runs));
}

TEST(ErrorCovariance, UsesAMeasurementOfAnEarlierState) {
  constexpr double p = 4, q = 0.5, r = 1;
  ErrorCovariance covariance(scalar_matrix(p));
  covariance.append(scalar_matrix(1));  // the state now
  covariance.predict(0, scalar_matrix(1), scalar_matrix(q));
  covariance.update(Eigen::RowVector2d(0, 1), scalar_matrix(r));
  covariance.remove(1, 1);
  ASSERT_EQ(covariance.size(), 1);
  EXPECT_NEAR(covariance.matrix()(0, 0), p * r / (p + r) + q, 1e-12);
}

TEST(ErrorCovariance, AddsLaterStatesToAnEarlierOne) {
  constexpr double p = 4, q = 0.5;
  ErrorCovariance covariance(scalar_matrix(p));
  covariance.append(scalar_matrix(-1));
  covariance.predict(0, scalar_matrix(1), scalar_matrix(q));
  covariance.add(1, Eigen::RowVector2d(1, 0));  // x(later) - x(earlier) is the noise between
  EXPECT_NEAR(covariance.matrix()(1, 1), q, 1e-12);
  EXPECT_NEAR(covariance.matrix()(0, 1), q, 1e-12);
}

TEST(ErrorCovariance, StaysPositiveWithNearlyExactMeasurements) {
  // Without Joseph's form rounding makes such covariances indefinite.
  ErrorCovariance covariance(Matrix2d(1e6 * Matrix2d::Identity()));
  for (int i = 0; i < 1000; ++i) {
    covariance.update(Eigen::RowVector2d(std::cos(1e-3 * i), std::sin(1e-3 * i)), scalar_matrix(1e-6));
    covariance.predict(0, Matrix2d::Identity(), 1e-9 * Matrix2d::Identity());
  }
  EXPECT_GT(covariance.matrix().eigenvalues().real().minCoeff(), 0);
}

}  // namespace
