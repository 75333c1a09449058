// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/filters/wall_ekf.hpp"

#include <cmath>

#include "sim/base/math.hpp"

namespace autonomy {

namespace {

/// A beam that meets a wall at a smaller angle than this is not used: its echo is smeared over the wall.
constexpr double grazing_sine = 0.4;

}  // namespace

std::optional<WallHit> first_wall(const std::vector<Wall>& walls, const Vector2d& from_W, double direction_rad,
                                  double margin_m) {
  const Vector2d v_W = turned({1, 0}, direction_rad);
  std::optional<WallHit> first;
  for (const Wall& wall : walls) {
    const Vector2d along_W = wall.to_W - wall.from_W;
    const double length_m = along_W.norm();
    // Near an end a beam may miss the wall or see its edge, and the range would fit neither.
    if (!(length_m > 2 * margin_m)) continue;
    Vector2d normal_W = left_of(along_W) / length_m;
    // Walls are seen from both sides.
    if (normal_W.dot(from_W - wall.from_W) < 0) normal_W = -normal_W;
    const double closing = -normal_W.dot(v_W);
    if (closing <= 0) continue;
    const double range_m = normal_W.dot(from_W - wall.from_W) / closing;
    const double at_m = along_W.dot(from_W + range_m * v_W - wall.from_W) / length_m;
    if (at_m < margin_m || at_m > length_m - margin_m || (first && first->range_m <= range_m)) continue;
    first = WallHit{range_m, normal_W};
  }
  return first;
}

WallEkf::WallEkf(const Vector2d& p_W, double position_std_m, double heading_offset_rad, double heading_std_rad,
                 const Params& params)
    : params_(params) {
  x_.head<2>() = p_W;
  x_[2] = heading_offset_rad;
  P_.diagonal() << squared(position_std_m), squared(position_std_m), squared(heading_std_rad),
      squared(params.current_std_mps), squared(params.current_std_mps);
}

double WallEkf::yaw_rad(double gyro_yaw_rad) const {
  return sim::wrap_angle(gyro_yaw_rad + x_[2]);
}

double WallEkf::heading_std_rad() const {
  return std::sqrt(P_(2, 2));
}

void WallEkf::predict(double dt_s, double gyro_yaw_rad, double speed_mps, double slip_mps) {
  const Vector2d u_W = turned({1, 0}, yaw_rad(gyro_yaw_rad));
  const Vector2d v_W = speed_mps * u_W + slip_mps * left_of(u_W);
  x_.head<2>() += (v_W + current_W()) * dt_s;
  Covariance F = Covariance::Identity();
  // A heading error moves the vehicle sideways, and the unknown current along with the water.
  F.block<2, 1>(0, 2) = dt_s * left_of(v_W);
  F.block<2, 2>(0, 3) = dt_s * Eigen::Matrix2d::Identity();
  P_ = F * P_ * F.transpose();
  P_.topLeftCorner<2, 2>() += squared(params_.speed_noise_mpsprtHz) * dt_s * Eigen::Matrix2d::Identity();
  P_(2, 2) += squared(params_.heading_noise_radprtHz) * dt_s;
  P_(3, 3) += squared(params_.current_noise_mpsprtHz) * dt_s;
  P_(4, 4) += squared(params_.current_noise_mpsprtHz) * dt_s;
}

void WallEkf::loosen_current(double std_mps) {
  P_(3, 3) += squared(std_mps);
  P_(4, 4) += squared(std_mps);
}

bool WallEkf::update(double innovation, const Eigen::Matrix<double, 1, 5>& H, double variance, bool gated) {
  const double S = (H * P_ * H.transpose())(0) + variance;
  if (gated && innovation * innovation > params_.gate * S) return false;
  const State K = P_ * H.transpose() / S;
  x_ += K * innovation;
  // Joseph form.
  const Covariance A = Covariance::Identity() - K * H;
  P_ = A * P_ * A.transpose() + variance * K * K.transpose();
  return true;
}

void WallEkf::update_position(const Vector2d& p_W, double std_m) {
  for (int i = 0; i < 2; ++i) {
    Eigen::Matrix<double, 1, 5> H = Eigen::Matrix<double, 1, 5>::Zero();
    H[i] = 1;
    update(p_W[i] - x_[i], H, squared(std_m), false);
  }
}

bool WallEkf::update_range(const std::vector<Wall>& walls, double gyro_yaw_rad, double beam_rad, double lever_m,
                           double range_m, double std_m) {
  const double heading_rad = yaw_rad(gyro_yaw_rad);
  const Vector2d u_W = turned({1, 0}, heading_rad);
  const Vector2d v_W = turned({1, 0}, heading_rad + beam_rad);
  // Room for the error of the estimate at the ends of a wall.
  const double margin_m = 1 + 2 * std::sqrt(position_covariance().trace());
  const auto hit = first_wall(walls, p_W() + lever_m * u_W, heading_rad + beam_rad, margin_m);
  if (!hit) return false;
  const double nv = hit->normal_W.dot(v_W);
  if (-nv < grazing_sine) return false;
  Eigen::Matrix<double, 1, 5> H = Eigen::Matrix<double, 1, 5>::Zero();
  H.head<2>() = -hit->normal_W.transpose() / nv;
  H[2] = -(lever_m * hit->normal_W.dot(left_of(u_W)) + hit->range_m * hit->normal_W.dot(left_of(v_W))) / nv;
  return update(range_m - hit->range_m, H, squared(std_m), true);
}

}  // namespace autonomy
