// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/filters/ekf.hpp"

#include <Eigen/LU>
#include <cmath>

#include "sim/base/math.hpp"

namespace autonomy {

namespace {}  // namespace

Ekf::Ekf(const Pose2& start, double position_std_m, double yaw_std_rad, const Params& params)
    : params_(params), pose_(start), P_(Eigen::Matrix3d::Zero()) {
  P_.diagonal() << squared(position_std_m), squared(position_std_m), squared(yaw_std_rad);
}

void Ekf::predict(const Increment& move) {
  const double c = std::cos(pose_.yaw_rad);
  const double s = std::sin(pose_.yaw_rad);
  const Vector2d moved_W = turned({move.forward_m, move.left_m}, pose_.yaw_rad);
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = -moved_W.y();
  F(1, 2) = moved_W.x();
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  R_WB.topLeftCorner<2, 2>() << c, -s, s, c;

  const double distance_m = std::hypot(move.forward_m, move.left_m);
  // Variances grow in proportion to distance and turn, so the result does not depend on how often odometry is
  // reported.
  Eigen::Matrix3d Q_B = Eigen::Matrix3d::Zero();
  Q_B.diagonal() << squared(params_.along_std_m) * distance_m, squared(params_.across_std_m) * distance_m,
      squared(params_.yaw_per_turn_std_rad) * std::abs(move.turn_rad) +
          squared(params_.yaw_per_meter_std_rad) * distance_m;

  pose_.p_W += moved_W;
  pose_.yaw_rad = sim::wrap_angle(pose_.yaw_rad + move.turn_rad);
  P_ = F * P_ * F.transpose() + R_WB * Q_B * R_WB.transpose();
}

bool Ekf::update_position(const Vector2d& p_W, double std_m) {
  Jacobian H = Jacobian::Zero();
  H.leftCols<2>().setIdentity();
  return update(p_W - pose_.p_W, H, squared(std_m) * Eigen::Matrix2d::Identity());
}

bool Ekf::update_relative(const Vector2d& p_BN_B, double seen_std_m, const Vector2d& p_WN_W, double neighbor_std_m) {
  const Vector2d d_W = p_WN_W - pose_.p_W;
  const Vector2d expected_B = turned(d_W, -pose_.yaw_rad);
  const double c = std::cos(pose_.yaw_rad);
  const double s = std::sin(pose_.yaw_rad);
  // h = R(yaw)^T (p_WN - p_WB): a move towards it makes it smaller, a left turn rotates it to the right.
  Jacobian H;
  H << -c, -s, expected_B.y(), s, -c, -expected_B.x();
  // Both errors are isotropic, so the rotation between the frames does not matter.
  const double variance = squared(seen_std_m) + squared(neighbor_std_m);
  return update(p_BN_B - expected_B, H, variance * Eigen::Matrix2d::Identity());
}

bool Ekf::update(const Vector2d& innovation, const Jacobian& H, const Eigen::Matrix2d& R) {
  const Eigen::Matrix2d S = H * P_ * H.transpose() + R;
  const Eigen::Matrix2d S_inverse = S.inverse();
  // This comparison also rejects NaN.
  if (!(innovation.dot(S_inverse * innovation) <= params_.gate)) {
    count_refusal();
    return false;
  }
  refusals_ = 0;
  const Eigen::Matrix<double, 3, 2> K = P_ * H.transpose() * S_inverse;
  const Eigen::Vector3d change = K * innovation;
  pose_.p_W += change.head<2>();
  pose_.yaw_rad = sim::wrap_angle(pose_.yaw_rad + change.z());
  // Joseph form of the covariance, which remains symmetric and positive under rounding.
  const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() - K * H;
  P_ = A * P_ * A.transpose() + K * R * K.transpose();
  return true;
}

void Ekf::count_refusal() {
  if (++refusals_ < params_.max_refusals) return;
  // Consecutive rejections are not outliers: an overconfident filter would reject forever.
  refusals_ = 0;
  P_.diagonal() += Eigen::Vector3d(squared(5.0), squared(5.0), squared(0.5));
}

double Ekf::position_std_m() const {
  return std::sqrt(0.5 * (P_(0, 0) + P_(1, 1)));
}

}  // namespace autonomy
