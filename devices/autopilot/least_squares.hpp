// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

namespace devices {

/// Returns the shortest x with the least |A x - b|, by Eigen's complete orthogonal decomposition.  Pivots below
/// `threshold` times the largest count as zero; unset: Eigen's default.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                              std::optional<double> threshold = std::nullopt);

}  // namespace devices
