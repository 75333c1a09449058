// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/scan_alignment.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace autonomy {

namespace {

/// Error of a point across a line: noise of both, and of what is not straight.
constexpr double line_std_m = 0.02;
/// Errors that all points of a pair of scans share.
constexpr double shared_std_m = 0.003, shared_std_rad = 0.0005;

}  // namespace

Outline::Outline(std::vector<Vector2d> points_B) : points_B_(std::move(points_B)), lines_(points_B_.size()) {
  constexpr double max_m = 1.5, straight_m = 0.04;
  for (std::size_t i = 1; i + 1 < points_B_.size(); ++i) {
    const Vector2d along = points_B_[i + 1] - points_B_[i - 1];
    const double length_m = along.norm();
    if (length_m > max_m || !(length_m > 0)) continue;
    const Vector2d normal = left_of(along) / length_m;
    if (std::abs(normal.dot(points_B_[i] - points_B_[i - 1])) > straight_m) continue;
    lines_[i] = {normal, 0.5 * length_m};
  }
}

std::optional<Alignment> align(const Outline& reference, const Outline& scan, const Pose2& guess, double gate_m) {
  constexpr int iterations = 15, min_points = 30;
  constexpr double last_gate_m = 0.06, narrows = 0.7, min_share = 0.4, beside_m = 0.03;
  const std::vector<Vector2d>& lines_B = reference.points_B();
  Pose2 pose = guess;
  Eigen::Matrix3d hessian;
  for (int iteration = 0; iteration < iterations; ++iteration, gate_m = std::max(last_gate_m, narrows * gate_m)) {
    hessian.setZero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    int matched = 0;
    for (const Vector2d& point_B : scan.points_B()) {
      const Vector2d arm = turned(point_B, pose.yaw_rad), point = pose.p_W + arm;
      std::size_t nearest = 0;
      double nearest_m2 = 1e30;
      for (std::size_t i = 0; i < lines_B.size(); ++i)
        if (const double distance_m2 = (point - lines_B[i]).squaredNorm(); distance_m2 < nearest_m2) {
          nearest_m2 = distance_m2;
          nearest = i;
        }
      if (nearest_m2 > 1e29) return std::nullopt;
      const Outline::Line& line = reference.line(nearest);
      const Vector2d to = point - lines_B[nearest];
      const double across_m = line.normal_B.dot(to);
      if (line.half_length_m == 0 || std::abs(across_m) > gate_m ||
          std::abs(left_of(line.normal_B).dot(to)) > line.half_length_m + beside_m)
        continue;
      ++matched;
      const Eigen::Vector3d jacobian(line.normal_B.x(), line.normal_B.y(), line.normal_B.dot(left_of(arm)));
      const double weight = 1 / (1 + squared(across_m / line_std_m));
      hessian += weight * jacobian * jacobian.transpose();
      gradient += weight * across_m * jacobian;
    }
    if (matched < min_points || matched < min_share * static_cast<double>(scan.points_B().size())) return std::nullopt;
    // Directions that the lines do not constrain keep their value.
    const Eigen::Matrix3d damped = hessian + 1e-3 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d step = damped.inverse() * gradient;
    pose.p_W -= step.head<2>();
    pose.yaw_rad -= step.z();
    constexpr double still = 1e-4;
    if (gate_m == last_gate_m && step.norm() < still) break;
  }
  const Eigen::Matrix3d open = hessian + 1e-3 * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d covariance = squared(line_std_m) * open.inverse();
  covariance.diagonal() += Eigen::Vector3d(squared(shared_std_m), squared(shared_std_m), squared(shared_std_rad));
  return Alignment{pose, covariance.inverse()};
}

}  // namespace autonomy
