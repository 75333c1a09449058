// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/linear_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace sim {

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
