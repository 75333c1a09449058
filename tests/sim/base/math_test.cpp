// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/math.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace {

using sim::Matrix3d;
using sim::Vector3d;
using std::numbers::pi;

TEST(Math, RollPitchYawTurnAboutFixedAxesInThisOrder) {
  // A quarter turn about x takes y to z; the following one about z leaves z as it is.
  const Matrix3d R = sim::rotation_from_rpy({pi / 2, 0, pi / 2});
  EXPECT_TRUE((R * Vector3d::UnitY()).isApprox(Vector3d::UnitZ()));
  EXPECT_TRUE((R * Vector3d::UnitX()).isApprox(Vector3d::UnitY()));
  // Nose down by positive pitch.
  EXPECT_TRUE((sim::rotation_from_rpy({0, pi / 2, 0}) * Vector3d::UnitX()).isApprox(-Vector3d::UnitZ()));
}

TEST(Math, AnglesComeBackFromTheRotation) {
  for (const Vector3d& rpy : {Vector3d(0.1, -0.2, 0.3), Vector3d(3, 1.5, -3), Vector3d(-2, -1.5, 2)})
    EXPECT_TRUE(sim::rpy_from_rotation(sim::rotation_from_rpy(rpy)).isApprox(rpy, 1e-12)) << rpy.transpose();
}

TEST(Math, APoseMapsPointsOfItsFrameToTheOther) {
  const sim::Pose X_AB = sim::make_pose({1, 2, 3}, {0, 0, pi / 2});
  EXPECT_TRUE((X_AB * Vector3d(1, 0, 0)).isApprox(Vector3d(1, 3, 3)));
  EXPECT_NEAR(sim::yaw_of(X_AB.linear()), pi / 2, 1e-15);
}

TEST(Math, AnglesAreWrappedToTheHalfOpenTurn) {
  EXPECT_EQ(sim::wrap_angle(0.5), 0.5);
  EXPECT_NEAR(sim::wrap_angle(2 * pi + 0.5), 0.5, 1e-15);
  EXPECT_NEAR(sim::wrap_angle(-7 * pi / 2), pi / 2, 1e-14);
  EXPECT_EQ(sim::wrap_angle(pi), pi);
  EXPECT_EQ(sim::wrap_angle(-pi), pi);
  EXPECT_NEAR(sim::wrap_angle(1e6 * 2 * pi + 1), 1, 1e-8);
}

TEST(Math, TheSmallestRotationTurnsOneDirectionIntoTheOther) {
  const Vector3d from(1, 2, 3), to(-2, 0.5, 1);
  const sim::Quaterniond q = sim::rotation_between(from, to);
  EXPECT_TRUE((q * from.normalized()).isApprox(to.normalized(), 1e-12));
  EXPECT_NEAR(q.angularDistance(sim::Quaterniond::Identity()), std::acos(from.normalized().dot(to.normalized())), 1e-9);
}

TEST(Math, TheMatrixOfACrossProductMultipliesAsIt) {
  const Vector3d a(1, -2, 3), b(4, 5, -6);
  EXPECT_TRUE((sim::cross_matrix(a) * b).isApprox(a.cross(b)));
}

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
