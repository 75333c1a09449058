// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/bound/error_covariance.hpp"

#include <Eigen/Cholesky>
#include <cstdint>
#include <vector>

namespace experiment {

void ErrorCovariance::predict(Eigen::Index first, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Q) {
  const Eigen::Index count = F.rows();
  P_.middleRows(first, count) = (F * P_.middleRows(first, count)).eval();
  P_.middleCols(first, count) = (P_.middleCols(first, count) * F.transpose()).eval();
  P_.block(first, first, count, count) += Q;
}

void ErrorCovariance::update(const Eigen::MatrixXd& H, const Eigen::MatrixXd& R) {
  const Eigen::MatrixXd PHt = P_ * H.transpose();
  const Eigen::LLT<Eigen::MatrixXd> innovation(H * PHt + R);
  if (innovation.info() != Eigen::Success) return;
  const Eigen::MatrixXd K = innovation.solve(PHt.transpose()).transpose();
  // (I - K H) P (I - K H)^T + K R K^T, without the full product I - K H.
  const Eigen::MatrixXd A = P_ - K * PHt.transpose();
  P_ = A - (A * H.transpose()) * K.transpose() + K * R * K.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

void ErrorCovariance::append(const Eigen::MatrixXd& C) {
  const Eigen::Index old = size();
  const Eigen::MatrixXd CP = C * P_;
  const Eigen::MatrixXd CPCt = CP * C.transpose();
  P_.conservativeResize(old + C.rows(), old + C.rows());
  P_.bottomLeftCorner(C.rows(), old) = CP;
  P_.topRightCorner(old, C.rows()) = CP.transpose();
  P_.bottomRightCorner(C.rows(), C.rows()) = CPCt;
}

void ErrorCovariance::add(Eigen::Index first, const Eigen::MatrixXd& C) {
  P_.middleRows(first, C.rows()) += (C * P_).eval();
  P_.middleCols(first, C.rows()) += (P_ * C.transpose()).eval();
}

void ErrorCovariance::remove(Eigen::Index first, Eigen::Index count) {
  const Eigen::Index rest = size() - first - count;
  P_.middleRows(first, rest) = P_.bottomRows(rest).eval();
  P_.middleCols(first, rest) = P_.rightCols(rest).eval();
  P_.conservativeResize(first + rest, first + rest);
}

void ErrorCovariance::visit_state(sim::StateArchive& archive) {
  std::uint32_t rows = static_cast<std::uint32_t>(size());
  std::vector<double> values(P_.data(), P_.data() + P_.size());
  archive(rows, values);
  if (!archive.restoring()) return;
  if (static_cast<std::uint64_t>(rows) * rows != values.size()) archive.fail("a covariance that is not square");
  P_ = Eigen::Map<const Eigen::MatrixXd>(values.data(), rows, rows);
}

}  // namespace experiment
