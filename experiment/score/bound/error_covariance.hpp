// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "sim/state/state_archive.hpp"

namespace experiment {

/// Covariance of the errors of a linear or linearized system: the recursion of a Kalman filter without its estimate.
/// With Jacobians at the true states it is the posterior Cramer-Rao bound of a system with Gaussian noise (Tichavsky,
/// Muravchik and Nehorai, IEEE Trans. Signal Processing 46(5), 1998): the inverse of their information matrix, and
/// unlike that also defined for errors without process noise.
class ErrorCovariance {
 public:
  ErrorCovariance() = default;
  explicit ErrorCovariance(Eigen::MatrixXd initial) : P_(std::move(initial)) {}

  Eigen::Index size() const { return P_.rows(); }
  const Eigen::MatrixXd& matrix() const { return P_; }

  /// Predicts the errors from `first` on, as many as F has rows: P <- F P F^T + Q.  The others do not change.
  void predict(Eigen::Index first, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Q);
  /// Updates with a measurement H x + v, v of covariance R, in Joseph's form: P <- (I - K H) P (I - K H)^T + K R K^T.
  /// `H`: a column for each error.  A measurement whose innovation has a singular covariance has no effect.
  void update(const Eigen::MatrixXd& H, const Eigen::MatrixXd& R);
  /// Appends linear combinations of the present errors, C x, such as a position that a later measurement refers to.
  /// These errors do not change with predictions.
  void append(const Eigen::MatrixXd& C);
  /// Adds linear combinations of the present errors to those from `first` on: x_first <- x_first + C x.
  void add(Eigen::Index first, const Eigen::MatrixXd& C);
  /// Removes `count` errors from `first` on.
  void remove(Eigen::Index first, Eigen::Index count);

  void visit_state(sim::StateArchive& archive);

 private:
  Eigen::MatrixXd P_;
};

}  // namespace experiment
