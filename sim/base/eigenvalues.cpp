// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace sim {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

Vector3d symmetric_eigenvalues(const Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

/// Jacobi's method: each rotation of the axes i and k clears the element (i, k).
double smallest_eigenvalue(const Matrix6d& matrix) {
  constexpr int max_sweeps = 50;  // 6 are enough in general
  Matrix6d a = matrix;
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    if (a.squaredNorm() - a.diagonal().squaredNorm() <= 0) break;
    for (int i = 0; i < 6; ++i)
      for (int k = i + 1; k < 6; ++k) {
        if (a(i, k) == 0) continue;
        const double ratio = (a(k, k) - a(i, i)) / (2 * a(i, k));
        const double tangent = (ratio < 0 ? -1 : 1) / (std::abs(ratio) + std::hypot(1, ratio));
        const double c = 1 / std::hypot(1, tangent), s = c * tangent;
        for (int n = 0; n < 6; ++n) {
          const double first = a(n, i), second = a(n, k);
          a(n, i) = c * first - s * second;
          a(n, k) = s * first + c * second;
        }
        for (int n = 0; n < 6; ++n) {
          const double first = a(i, n), second = a(k, n);
          a(i, n) = c * first - s * second;
          a(k, n) = s * first + c * second;
        }
      }
  }
  return a.diagonal().minCoeff();
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
