// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/least_squares.hpp"

#include <Eigen/QR>

namespace devices {

Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, std::optional<double> threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  if (threshold) solver.setThreshold(*threshold);
  solver.compute(A);
  return solver.solve(b);
}

}  // namespace devices
