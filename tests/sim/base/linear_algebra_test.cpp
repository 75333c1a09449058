// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/linear_algebra.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double rounding = 1e-12;  // a few operations on numbers of order 10

TEST(LinearAlgebra, EigenvaluesOfASymmetricMatrixAreInAscendingOrder) {
  const sim::Matrix3d turn = Eigen::AngleAxisd(0.7, sim::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const sim::Vector3d values =
      sim::symmetric_eigenvalues(turn * sim::Vector3d(5, -2, 3).asDiagonal() * turn.transpose());
  EXPECT_TRUE(values.isApprox(sim::Vector3d(-2, 3, 5), rounding)) << values.transpose();
}

TEST(LinearAlgebra, TheSmallestEigenvalueKeepsItsSign) {
  Matrix6d matrix = 4 * Matrix6d::Identity();
  matrix(0, 5) = matrix(5, 0) = 6;  // 4 + 6 and 4 - 6
  EXPECT_NEAR(sim::smallest_eigenvalue(matrix), -2, rounding);
}

TEST(LinearAlgebra, TheSpectralRadiusCountsNegativeAndComplexEigenvalues) {
  Matrix6d matrix = Matrix6d::Zero();
  EXPECT_EQ(sim::spectral_radius(matrix), 0);
  matrix(0, 1) = 100;  // nilpotent: no power of it grows
  EXPECT_NEAR(sim::spectral_radius(matrix), 0, rounding);
  matrix(2, 2) = -3;
  EXPECT_NEAR(sim::spectral_radius(matrix), 3, rounding);
  matrix(3, 4) = 8;  // +-4i
  matrix(4, 3) = -2;
  EXPECT_NEAR(sim::spectral_radius(matrix), 4, rounding);
}

TEST(LinearAlgebra, LeastSquaresOfManySolutionsIsTheShortest) {
  const Eigen::MatrixXd A = Eigen::RowVector3d(1, 2, 2);
  const Eigen::VectorXd x = sim::least_squares(A, Eigen::VectorXd::Constant(1, 9));
  EXPECT_TRUE(x.isApprox(Eigen::Vector3d(1, 2, 2), rounding)) << x.transpose();  // A^T b / |A|^2
}

TEST(LinearAlgebra, LeastSquaresOfNoSolutionIsTheNearest) {
  const Eigen::MatrixXd A = Eigen::Vector3d::Ones();
  EXPECT_NEAR(sim::least_squares(A, Eigen::Vector3d(1, 2, 6))[0], 3, rounding);  // the mean
}

TEST(LinearAlgebra, LeastSquaresIgnoresDirectionsBelowTheThreshold) {
  const Eigen::MatrixXd A = Eigen::Vector2d(1, 0.01).asDiagonal();
  const Eigen::Vector2d b(1, 1);
  EXPECT_NEAR(sim::least_squares(A, b)[1], 100, 100 * rounding);
  EXPECT_EQ(sim::least_squares(A, b, 0.05)[1], 0);
}

}  // namespace
