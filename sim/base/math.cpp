// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/math.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace sim {

Matrix3d rotation_from_rpy(const Vector3d& rpy_rad) {
  return (Eigen::AngleAxisd(rpy_rad.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy_rad.y(), Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy_rad.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Vector3d rpy_from_rotation(const Matrix3d& R) {
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

Pose make_pose(const Vector3d& position_m, const Vector3d& rpy_rad) {
  Pose X = Pose::Identity();
  X.linear() = rotation_from_rpy(rpy_rad);
  X.translation() = position_m;
  return X;
}

double yaw_of(const Matrix3d& R) {
  return std::atan2(R(1, 0), R(0, 0));
}

Quaterniond rotation_between(const Vector3d& from, const Vector3d& to) {
  return Quaterniond::FromTwoVectors(from, to);
}

double wrap_angle(double angle_rad) {
  if (std::abs(angle_rad) < std::numbers::pi) return angle_rad;  // as the remainder, but without its cost
  const double wrapped = std::remainder(angle_rad, 2 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? wrapped + 2 * std::numbers::pi : wrapped;
}

using Matrix6d = Eigen::Matrix<double, 6, 6>;

Vector3d symmetric_eigenvalues(const Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

double smallest_eigenvalue(const Matrix6d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

double spectral_radius(const Matrix6d& matrix) {
  return Eigen::EigenSolver<Matrix6d>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, std::optional<double> threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  if (threshold) solver.setThreshold(*threshold);
  solver.compute(A);
  return solver.solve(b);
}

}  // namespace sim
