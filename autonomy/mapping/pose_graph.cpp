// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/pose_graph.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>

#include "sim/base/math.hpp"

namespace autonomy {

Pose2 seen_from(const Pose2& a, const Pose2& b) {
  return {turned(b.p_W - a.p_W, -a.yaw_rad), sim::wrap_angle(b.yaw_rad - a.yaw_rad)};
}

Pose2 composed(const Pose2& a, const Pose2& in_a) {
  return {a.p_W + turned(in_a.p_W, a.yaw_rad), sim::wrap_angle(a.yaw_rad + in_a.yaw_rad)};
}

int PoseGraph::add_pose(const Pose2& pose) {
  poses_.push_back(pose);
  return static_cast<int>(poses_.size()) - 1;
}

void PoseGraph::add_measurement(int from, int to, const Alignment& measured) {
  measurements_.push_back({from, to, measured});
}

void PoseGraph::optimize(int iterations) {
  using Eigen::Matrix3d, Eigen::Vector3d;
  constexpr double huber = 3;  // standard deviations
  const auto size = static_cast<Eigen::Index>(3 * (poses_.size() - 1));
  if (size == 0) return;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
    for (const Measurement& each : measurements_) {
      const Pose2 &from = poses_[static_cast<std::size_t>(each.from)], &to = poses_[static_cast<std::size_t>(each.to)];
      const Pose2 relative = seen_from(from, to);
      Vector3d error;
      error << relative.p_W - each.measured.pose.p_W, sim::wrap_angle(relative.yaw_rad - each.measured.pose.yaw_rad);
      // Derivatives by both poses.
      const double c = std::cos(from.yaw_rad), s = std::sin(from.yaw_rad);
      Matrix3d by_to = Matrix3d::Identity(), by_from;
      by_to.topLeftCorner<2, 2>() << c, s, -s, c;
      by_from = -by_to;
      by_from.topRightCorner<2, 1>() = -left_of(relative.p_W);
      const double deviation = std::sqrt(error.dot(each.measured.information * error));
      const Matrix3d weight = std::min(1.0, huber / std::max(deviation, 1e-9)) * each.measured.information;
      const std::pair<int, const Matrix3d*> sides[] = {{each.from, &by_from}, {each.to, &by_to}};
      for (const auto& [i, by_i] : sides) {
        if (i == 0) continue;
        gradient.segment<3>(3 * (i - 1)) += by_i->transpose() * weight * error;
        for (const auto& [k, by_k] : sides) {
          if (k == 0) continue;
          const Matrix3d block = by_i->transpose() * weight * *by_k;
          for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
              entries.emplace_back(3 * (i - 1) + row, 3 * (k - 1) + column, block(row, column));
        }
      }
    }
    Eigen::SparseMatrix<double> hessian(size, size);
    hessian.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(hessian);
    if (solver.info() != Eigen::Success) return;
    const Eigen::VectorXd step = solver.solve(gradient);
    if (!step.allFinite()) return;
    for (std::size_t i = 1; i < poses_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 * (i - 1));
      poses_[i].p_W -= step.segment<2>(at);
      poses_[i].yaw_rad = sim::wrap_angle(poses_[i].yaw_rad - step[at + 2]);
    }
    constexpr double still = 1e-5;
    if (step.lpNorm<Eigen::Infinity>() < still) break;
  }
}

}  // namespace autonomy
