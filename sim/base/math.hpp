// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>

namespace sim {

using Vector3d = Eigen::Vector3d;
using Matrix3d = Eigen::Matrix3d;
using Quaterniond = Eigen::Quaterniond;
/// Pose X_AB of frame B in frame A: maps a point given in B to A.
using Pose = Eigen::Isometry3d;

constexpr double degrees_to_radians(double angle_deg) {
  return angle_deg * std::numbers::pi / 180.0;
}
constexpr double radians_to_degrees(double angle_rad) {
  return angle_rad * 180.0 / std::numbers::pi;
}

/// Rotation by roll, pitch, yaw about the fixed x, y and z axes, in that order: Rz(yaw) Ry(pitch) Rx(roll).
Matrix3d rotation_from_rpy(const Vector3d& rpy_rad);
/// Roll, pitch, yaw of a rotation; pitch in [-pi/2, pi/2].
Vector3d rpy_from_rotation(const Matrix3d& R);
Pose make_pose(const Vector3d& position_m, const Vector3d& rpy_rad);
/// Yaw of a rotation about world z, in (-pi, pi].
double yaw_of(const Matrix3d& R);
/// Returns the angle wrapped to (-pi, pi].
double wrap_angle(double angle_rad);

/// Smallest rotation that turns one direction into another.
Quaterniond rotation_between(const Vector3d& from, const Vector3d& to);

/// Skew-symmetric cross-product matrix S(v): S(v) * x equals the cross product of v and x.
inline Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

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
