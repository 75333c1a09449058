// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace sim {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

Vector3d symmetric_eigenvalues(const Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

double smallest_eigenvalue(const Matrix6d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// Gelfand's formula: the limit of |A^k|^(1/k), here for k = 1, 2, 4, ...
double spectral_radius(const Matrix6d& matrix) {
  constexpr int doublings = 50;
  Matrix6d power = matrix;  // divided by its norm each time
  double log_radius = 0, share = 1;
  for (int i = 0; i < doublings; ++i, share /= 2) {
    const double norm = power.norm();
    if (!(norm > 0)) return 0;
    log_radius += share * std::log(norm);
    power /= norm;
    power = (power * power).eval();
  }
  return std::exp(log_radius);
}

}  // namespace sim
