// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/scan_matcher.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace autonomy {

namespace {

/// Ends of beams as offsets in cells from the pose, for one heading.
struct Offsets {
  std::vector<int> columns, rows;
  void set(const std::vector<Vector2d>& points_B, double yaw_rad, double x_m, double y_m, double cell_m) {
    columns.resize(points_B.size());
    rows.resize(points_B.size());
    const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
    for (std::size_t i = 0; i < points_B.size(); ++i) {
      columns[i] = static_cast<int>(std::floor((x_m + c * points_B[i].x() - s * points_B[i].y()) / cell_m));
      rows[i] = static_cast<int>(std::floor((y_m + s * points_B[i].x() + c * points_B[i].y()) / cell_m));
    }
  }
};

double score_from(int sum, std::size_t points) {
  return sum / (255.0 * static_cast<double>(points));
}

/// Improves a pose by trying a step of each coordinate to both sides, and halving the steps when none is better.
/// `loss(pose)` is taken from the score.
template <class Loss>
ScanMatch climb(const OccupancyMap& map, const std::vector<Vector2d>& points_B, ScanMatch best, double step_m,
                double step_rad, Loss loss) {
  constexpr double finest_m = 0.001;
  best.score = score_of(map, points_B, best.pose) - loss(best.pose);
  while (step_m > finest_m) {
    const double before = best.score;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) {
        Pose2 pose = best.pose;
        (axis == 0 ? pose.p_W.x() : axis == 1 ? pose.p_W.y() : pose.yaw_rad) += side * (axis == 2 ? step_rad : step_m);
        const double score = score_of(map, points_B, pose) - loss(pose);
        if (score <= best.score) continue;
        best = {pose, score};
        break;
      }
    if (best.score > before) continue;
    step_m /= 2;
    step_rad /= 2;
  }
  return best;
}

}  // namespace

double score_of(const OccupancyMap& map, const std::vector<Vector2d>& points_B, const Pose2& pose) {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  double sum = 0;
  for (const Vector2d& p : points_B)
    sum += map.field(pose.p_W + Vector2d(c * p.x() - s * p.y(), s * p.x() + c * p.y()));
  return points_B.empty() ? 0 : sum / static_cast<double>(points_B.size());
}

ScanMatch ScanMatcher::match(const OccupancyMap& map, const std::vector<Vector2d>& points_B, const Pose2& predicted,
                             const Eigen::Matrix3d& information) const {
  if (points_B.empty()) return {predicted, 0};
  const double cell_m = map.params().cell_m;
  const double independent = params_.independent * static_cast<double>(points_B.size());
  const auto loss = [&](const Pose2& pose) {
    const Eigen::Vector3d off(pose.p_W.x() - predicted.p_W.x(), pose.p_W.y() - predicted.p_W.y(),
                              pose.yaw_rad - predicted.yaw_rad);
    return 0.5 * off.dot(information * off) / independent;
  };
  // Mostly odometry is right to a part of a cell.
  const ScanMatch near = climb(map, points_B, {predicted, 0}, cell_m / 2, params_.step_rad / 2, loss);
  if (near.score >= params_.good_score) return {near.pose, near.score + loss(near.pose)};
  // All poses of the window; half of the points suffice.
  std::vector<Vector2d> some;
  for (std::size_t i = 0; i < points_B.size(); i += 2) some.push_back(points_B[i]);
  const int cells = static_cast<int>(std::ceil(params_.window_m / cell_m));
  const int turns = static_cast<int>(std::ceil(params_.window_rad / params_.step_rad));
  const double x_m = predicted.p_W.x() - map.params().low_W.x(), y_m = predicted.p_W.y() - map.params().low_W.y();
  Offsets offsets;
  ScanMatch best{predicted, -1};
  for (int turn = -turns; turn <= turns; ++turn) {
    const double yaw_rad = predicted.yaw_rad + turn * params_.step_rad;
    offsets.set(some, yaw_rad, x_m, y_m, cell_m);
    for (int row = -cells; row <= cells; ++row)
      for (int column = -cells; column <= cells; ++column) {
        int sum = 0;
        for (std::size_t i = 0; i < some.size(); ++i)
          sum += map.field_at(offsets.columns[i] + column, offsets.rows[i] + row);
        const Pose2 pose{predicted.p_W + cell_m * Vector2d(column, row), yaw_rad};
        const double score = score_from(sum, some.size()) - loss(pose);
        if (score > best.score) best = {pose, score};
      }
  }
  best = climb(map, points_B, best, cell_m / 2, params_.step_rad / 2, loss);
  best.score += loss(best.pose);
  return best;
}

Eigen::Matrix3d ScanMatcher::information_of(const OccupancyMap& map, const std::vector<Vector2d>& points_B,
                                            const Pose2& pose) const {
  // About the width of the field.
  const Eigen::Vector3d steps(0.04, 0.04, 0.005);
  const auto score = [&](const Eigen::Vector3d& off) {
    return score_of(map, points_B, {pose.p_W + off.head<2>(), pose.yaw_rad + off.z()});
  };
  Eigen::Matrix3d curvature;
  const double here = score(Eigen::Vector3d::Zero());
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k <= i; ++k) {
      const Eigen::Vector3d a = steps[i] * Eigen::Vector3d::Unit(i), b = steps[k] * Eigen::Vector3d::Unit(k);
      const double sum = i == k ? 2 * here - score(a) - score(-a)
                                : 0.25 * (score(a - b) + score(b - a) - score(a + b) - score(-a - b));
      curvature(i, k) = curvature(k, i) = sum / (steps[i] * steps[k]);
    }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(curvature);
  const Eigen::Vector3d values = axes.eigenvalues().cwiseMax(0);
  return params_.independent * static_cast<double>(points_B.size()) * axes.eigenvectors() * values.asDiagonal() *
         axes.eigenvectors().transpose();
}

}  // namespace autonomy
