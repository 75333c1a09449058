// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/base/math.hpp"

namespace sim {

// Eigen's solvers take seconds to compile in each object that calls them: here is what the simulator needs of them.

/// Returns the eigenvalues of a symmetric matrix, in ascending order.
Vector3d symmetric_eigenvalues(const Matrix3d& matrix);

/// Returns the smallest eigenvalue of a symmetric matrix.
double smallest_eigenvalue(const Eigen::Matrix<double, 6, 6>& matrix);

/// Returns the largest magnitude of the eigenvalues of a matrix, which need not be symmetric.
double spectral_radius(const Eigen::Matrix<double, 6, 6>& matrix);

/// Returns the shortest x with the least |A x - b|, by a complete orthogonal decomposition.  Pivots below `threshold`
/// times the largest count as zero; unset: Eigen's default.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                              std::optional<double> threshold = std::nullopt);

}  // namespace sim
