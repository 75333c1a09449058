// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/path.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr int pieces_per_segment = 16;

/// Returns the rotation whose x axis is the horizontal direction of travel; identity for a vertical path.
Matrix3d heading(const Vector3d& direction_W) {
  if (direction_W.head<2>().norm() < 1e-9 * direction_W.norm()) return Matrix3d::Identity();
  return rotation_from_rpy({0, 0, std::atan2(direction_W.y(), direction_W.x())});
}

}  // namespace

double Path::Cubic::length(double from, double to) const {
  // Gauss-Legendre with five points: exact for polynomials up to degree 9.
  static constexpr double x[] = {0.0, 0.5384693101056831, 0.9061798459386640};
  static constexpr double w[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double middle = (from + to) / 2;
  const double half = (to - from) / 2;
  double sum = w[0] * slope(middle).norm();
  for (int i = 1; i < 3; ++i) sum += w[i] * (slope(middle - half * x[i]).norm() + slope(middle + half * x[i]).norm());
  return half * sum;
}

Path Path::through(PathKind kind, std::vector<Vector3d> points_W, bool closed, std::optional<Matrix3d> R_WO) {
  Path path;
  path.kind_ = kind;
  path.R_WO_ = R_WO;
  // A repeated first point would make a last segment without length and direction.
  if (closed && points_W.front() == points_W.back()) points_W.pop_back();
  if (kind == PathKind::spline) {
    path.add_spline(points_W, closed);
  } else {
    if (closed) points_W.push_back(points_W.front());
    path.add_lines(points_W);
  }
  return path;
}

void Path::add_lines(const std::vector<Vector3d>& points_W) {
  for (std::size_t i = 0; i + 1 < points_W.size(); ++i) {
    const Vector3d along = points_W[i + 1] - points_W[i];
    cubics_.push_back({{points_W[i], along, Vector3d::Zero(), Vector3d::Zero()}});
    from_.push_back(0);
    to_.push_back(1);
    starts_.push_back(starts_.back() + along.norm());
  }
}

void Path::add_spline(const std::vector<Vector3d>& points_W, bool closed) {
  // Barry and Goldman 1988, "A recursive evaluation algorithm for a class of Catmull-Rom splines", with knots at the
  // square root of the chord (centripetal): no loops and no overshoot.  An open end is mirrored at its last point.
  const auto count = static_cast<int>(points_W.size());
  // Control points, wrapped or mirrored at the ends.
  const auto point = [&](int i) -> Vector3d {
    if (closed) return points_W[static_cast<std::size_t>((i + count) % count)];
    if (i < 0) return 2 * points_W[0] - points_W[1];
    if (i >= count) return 2 * points_W[points_W.size() - 1] - points_W[points_W.size() - 2];
    return points_W[static_cast<std::size_t>(i)];
  };
  for (int i = 0; i < (closed ? count : count - 1); ++i) {
    // Tangents of the segment.
    const Vector3d p0 = point(i - 1), p1 = point(i), p2 = point(i + 1), p3 = point(i + 2);
    const double d0 = std::sqrt((p1 - p0).norm()), d1 = std::sqrt((p2 - p1).norm()), d2 = std::sqrt((p3 - p2).norm());
    const Vector3d m1 = d1 * ((p1 - p0) / d0 - (p2 - p0) / (d0 + d1) + (p2 - p1) / d1);
    const Vector3d m2 = d1 * ((p2 - p1) / d1 - (p3 - p1) / (d1 + d2) + (p3 - p2) / d2);
    // Cubic Hermite polynomial, divided into pieces.
    const Cubic cubic{{p1, m1, 3 * (p2 - p1) - 2 * m1 - m2, 2 * (p1 - p2) + m1 + m2}};
    for (int k = 0; k < pieces_per_segment; ++k) {
      cubics_.push_back(cubic);
      from_.push_back(static_cast<double>(k) / pieces_per_segment);
      to_.push_back(static_cast<double>(k + 1) / pieces_per_segment);
      starts_.push_back(starts_.back() + cubic.length(from_.back(), to_.back()));
    }
  }
}

Path Path::timed(const std::vector<TimedPose>& poses) {
  Path path;
  path.kind_ = PathKind::timed;
  for (const TimedPose& pose : poses) {
    path.poses_.push_back(make_pose(pose.position_m, pose.rpy_rad));
    if (path.poses_.size() > 1) path.starts_.push_back(pose.at_s - poses.front().at_s);
  }
  return path;
}

Pose Path::pose_at(double u) const {
  u = std::clamp(u, 0.0, length());
  const auto after = std::upper_bound(starts_.begin() + 1, starts_.end() - 1, u);
  const auto i = static_cast<std::size_t>(after - starts_.begin()) - 1;
  if (kind_ == PathKind::timed) return timed_pose_at(i, u);
  const double t = parameter_at(i, u);
  Pose X_WO = Pose::Identity();
  X_WO.translation() = cubics_[i].at(t);
  X_WO.linear() = R_WO_ ? *R_WO_ : heading(cubics_[i].slope(t));
  return X_WO;
}

double Path::parameter_at(std::size_t i, double u) const {
  const double share = (u - starts_[i]) / (starts_[i + 1] - starts_[i]);
  double t = from_[i] + share * (to_[i] - from_[i]);
  if (kind_ == PathKind::waypoints) return t;
  // Solve for the parameter by Newton's method; the speed is nearly constant within a piece, so that few iterations
  // reach rounding error.
  for (int round = 0; round < 4; ++round) {
    const double error_m = starts_[i] + cubics_[i].length(from_[i], t) - u;
    const double speed = cubics_[i].slope(t).norm();
    if (speed <= 0 || std::abs(error_m) < 1e-12) break;
    t = std::clamp(t - error_m / speed, from_[i], to_[i]);
  }
  return t;
}

Pose Path::timed_pose_at(std::size_t i, double u) const {
  if (poses_.size() == 1) return poses_[0];
  const double share = (u - starts_[i]) / (starts_[i + 1] - starts_[i]);
  if (share <= 0) return poses_[i];
  if (share >= 1) return poses_[i + 1];
  Pose X_WO = Pose::Identity();
  X_WO.translation() = (1 - share) * poses_[i].translation() + share * poses_[i + 1].translation();
  const Quaterniond first(poses_[i].linear()), second(poses_[i + 1].linear());
  X_WO.linear() = first.slerp(share, second).normalized().toRotationMatrix();
  return X_WO;
}

}  // namespace sim
