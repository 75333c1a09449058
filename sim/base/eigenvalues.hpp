// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/math.hpp"

namespace sim {

// Eigen's solvers take seconds to compile in each object that calls them: here is what the simulator needs of them.

/// Returns the eigenvalues of a symmetric matrix, in ascending order.
Vector3d symmetric_eigenvalues(const Matrix3d& matrix);

/// Returns the smallest eigenvalue of a symmetric matrix.
double smallest_eigenvalue(const Eigen::Matrix<double, 6, 6>& matrix);

/// Returns the largest magnitude of the eigenvalues of a matrix, which need not be symmetric, to nine digits.
double spectral_radius(const Eigen::Matrix<double, 6, 6>& matrix);

}  // namespace sim
