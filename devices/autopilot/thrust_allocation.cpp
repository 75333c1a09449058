// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/thrust_allocation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/base/math.hpp"

namespace devices {

const std::vector<std::string>& wrench_axes() {
  static const std::vector<std::string> names{"surge", "sway", "heave", "roll", "pitch", "yaw"};
  return names;
}

ThrustAllocation::ThrustAllocation(std::vector<ThrusterPlace> thrusters, const std::vector<int>& axes)
    : thrusters_(std::move(thrusters)), effect_(6, static_cast<Eigen::Index>(thrusters_.size())) {
  // Wrench of a unit force of each thruster.
  double arms = 0;
  for (std::size_t i = 0; i < thrusters_.size(); ++i) {
    const sim::Vector3d push = thrusters_[i].X_ST.linear().col(0);
    const sim::Vector3d torque = thrusters_[i].X_ST.translation().cross(push);
    effect_.col(static_cast<Eigen::Index>(i)) << push, torque;
    arms += torque.squaredNorm();
  }
  arm_m_ = std::max(1e-3, std::sqrt(arms / static_cast<double>(std::max<std::size_t>(1, thrusters_.size()))));
  // Choose the axes and check that they are controllable.
  axes_ = axes;
  if (axes.empty()) {
    for (const int axis : {0, 5, 2, 1, 3, 4}) {
      axes_.push_back(axis);
      if (!controllable(axes_)) axes_.pop_back();
    }
  }
  for (std::size_t n = 1; n <= axes_.size(); ++n)
    if (!controllable({axes_.begin(), axes_.begin() + static_cast<std::ptrdiff_t>(n)}))
      throw std::invalid_argument("the thrusters cannot give " + wrench_axes()[static_cast<std::size_t>(axes_[n - 1])] +
                                  (n > 1 ? " in addition to the axes before it" : ""));
  if (axes_.empty()) throw std::invalid_argument("the thrusters produce no force");
  // Weighted pseudo-inverse W^-1 B^T (B W^-1 B^T)^-1.
  const Eigen::Index rows = static_cast<Eigen::Index>(axes_.size());
  Eigen::MatrixXd effect(rows, effect_.cols());
  for (Eigen::Index row = 0; row < rows; ++row) effect.row(row) = effect_.row(axes_[static_cast<std::size_t>(row)]);
  Eigen::VectorXd ease(effect_.cols());
  for (Eigen::Index i = 0; i < ease.size(); ++i) ease[i] = 1 / thrusters_[static_cast<std::size_t>(i)].weight;
  const Eigen::MatrixXd eased = ease.asDiagonal() * effect.transpose();
  inverse_ = eased * (effect * eased).inverse();
}

/// Returns true when the axes are independent with a margin: a singular value below 0.05 would need huge forces.
bool ThrustAllocation::controllable(const std::vector<int>& axes) const {
  constexpr double min_singular_value = 0.05;
  if (axes.size() > 6 || static_cast<Eigen::Index>(axes.size()) > effect_.cols()) return false;
  // The eigenvalues of these products are the squares of the singular values.  Axes that are left out have 1.
  Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Identity();
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (std::size_t k = 0; k < axes.size(); ++k)
      products(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          effect_.row(axes[i]).dot(effect_.row(axes[k])) / ((axes[i] < 3 ? 1 : arm_m_) * (axes[k] < 3 ? 1 : arm_m_));
  return sim::smallest_eigenvalue(products) > min_singular_value * min_singular_value;
}

bool ThrustAllocation::gives(int axis) const {
  return std::find(axes_.begin(), axes_.end(), axis) != axes_.end();
}

/// Returns true when the limit in the direction of the force is at most a hundredth of the larger limit of both
/// directions.
bool ThrustAllocation::cannot_push(Eigen::Index thruster, double force_N) const {
  const ThrusterPlace& place = thrusters_[static_cast<std::size_t>(thruster)];
  const double limit = std::abs(force_N > 0 ? place.max_N : place.min_N);
  return force_N != 0 && limit <= 0.01 * std::max(place.max_N, -place.min_N);
}

/// Computes the weighted least-norm forces among those closest to the wrench, without the dropped thrusters.  Thrusters
/// that cannot produce their force are dropped in turn (active set method).  Returns the share of the wrench produced.
double ThrustAllocation::nearest(const Wrench& desired, std::vector<bool> dropped, Eigen::VectorXd& forces_N) const {
  // Target and effect, with torques scaled to forces by the mean arm.
  const auto rows = static_cast<Eigen::Index>(axes_.size());
  Eigen::VectorXd target(rows), given(rows);
  Eigen::MatrixXd effect(rows, effect_.cols());
  for (Eigen::Index row = 0; row < rows; ++row) {
    const int axis = axes_[static_cast<std::size_t>(row)];
    const double arm = axis < 3 ? 1 : arm_m_;
    target[row] = desired[axis] / arm;
    effect.row(row) = effect_.row(axis) / arm;
  }
  // Solve and drop thrusters until the forces are feasible.
  for (bool again = true; again;) {
    again = false;
    Eigen::VectorXd ease(effect.cols());
    for (Eigen::Index i = 0; i < ease.size(); ++i)
      ease[i] =
          dropped[static_cast<std::size_t>(i)] ? 0 : 1 / std::sqrt(thrusters_[static_cast<std::size_t>(i)].weight);
    forces_N = ease.cwiseProduct(sim::least_squares(effect * ease.asDiagonal(), target, 0.05));
    for (Eigen::Index i = 0; i < forces_N.size(); ++i)
      if (!dropped[static_cast<std::size_t>(i)] && cannot_push(i, forces_N[i]))
        again = dropped[static_cast<std::size_t>(i)] = true;
    given = effect * forces_N;
  }
  // Share of the target along its own direction.
  const double square = target.squaredNorm();
  return square > 0 ? std::clamp(given.dot(target) / square, 0.0, 1.0) : 1;
}

/// Returns the largest share, 0 to 1, of the second forces that the thrusters can give beside the first.
double ThrustAllocation::possible_share(const Eigen::VectorXd& first_N, const Eigen::VectorXd& then_N) const {
  double share = 1;
  for (Eigen::Index i = 0; i < then_N.size(); ++i) {
    const ThrusterPlace& thruster = thrusters_[static_cast<std::size_t>(i)];
    const double both_N = first_N[i] + then_N[i], limit_N = both_N > 0 ? thruster.max_N : thruster.min_N;
    if (both_N * then_N[i] > 0 && std::abs(both_N) > std::abs(limit_N))
      share = std::min(share, std::max(0.0, (limit_N - first_N[i]) / then_N[i]));
  }
  return share;
}

double ThrustAllocation::allocate(const Wrench& desired, Eigen::VectorXd& forces_N) const {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(effect_.cols());
  forces_N = none;
  if (!desired.allFinite()) return 0;
  // Unconstrained solution, and the part of it for roll and pitch.
  Eigen::VectorXd level_N = none;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Eigen::VectorXd part_N = inverse_.col(static_cast<Eigen::Index>(i)) * desired[axes_[i]];
    forces_N += part_N;
    if (axes_[i] == 3 || axes_[i] == 4) level_N += part_N;
  }
  // Drop thrusters that cannot push in the required direction.
  std::vector<bool> dropped(thrusters_.size());
  for (std::size_t i = 0; i < dropped.size(); ++i)
    dropped[i] = cannot_push(static_cast<Eigen::Index>(i), forces_N[static_cast<Eigen::Index>(i)]);
  double share = 1;
  if (std::find(dropped.begin(), dropped.end(), true) != dropped.end()) {
    share = nearest(desired, dropped, forces_N);
    level_N = none;
  }
  // Scale the forces to the limits.
  const Eigen::VectorXd rest_N = forces_N - level_N;
  const double level = possible_share(none, level_N);
  level_N *= level;
  const double rest = possible_share(level_N, rest_N);
  forces_N = level_N + rest * rest_N;
  return std::min(level, rest) * share;
}

}  // namespace devices
