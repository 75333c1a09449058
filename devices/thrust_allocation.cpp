#include "devices/thrust_allocation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace devices {

const std::vector<std::string>& wrench_axes() {
  static const std::vector<std::string> names{"surge", "sway", "heave", "roll", "pitch", "yaw"};
  return names;
}

ThrustAllocation::ThrustAllocation(std::vector<ThrusterPlace> thrusters, const std::vector<int>& axes)
    : thrusters_(std::move(thrusters)), effect_(6, static_cast<Eigen::Index>(thrusters_.size())) {
  double arms = 0;
  for (std::size_t i = 0; i < thrusters_.size(); ++i) {
    const sim::Vector3d push = thrusters_[i].X_ST.linear().col(0);
    const sim::Vector3d torque = thrusters_[i].X_ST.translation().cross(push);
    effect_.col(static_cast<Eigen::Index>(i)) << push, torque;
    arms += torque.squaredNorm();
  }
  arm_m_ = std::max(1e-3, std::sqrt(arms / static_cast<double>(std::max<std::size_t>(1, thrusters_.size()))));
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
                                  (n > 1 ? " beside the axes before it" : ""));
  if (axes_.empty()) throw std::invalid_argument("the thrusters push nowhere");
  const Eigen::Index rows = static_cast<Eigen::Index>(axes_.size());
  Eigen::MatrixXd effect(rows, effect_.cols());
  for (Eigen::Index row = 0; row < rows; ++row) effect.row(row) = effect_.row(axes_[static_cast<std::size_t>(row)]);
  Eigen::VectorXd ease(effect_.cols());
  for (Eigen::Index i = 0; i < ease.size(); ++i) ease[i] = 1 / thrusters_[static_cast<std::size_t>(i)].weight;
  const Eigen::MatrixXd eased = ease.asDiagonal() * effect.transpose();
  inverse_ = eased * (effect * eased).inverse();
}

/// The axes are independent, by a margin: an arm of a twentieth of the others' would ask for huge forces.
bool ThrustAllocation::controllable(const std::vector<int>& axes) const {
  if (static_cast<Eigen::Index>(axes.size()) > effect_.cols()) return false;
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(axes.size()), effect_.cols());
  for (std::size_t i = 0; i < axes.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = effect_.row(axes[i]) / (axes[i] < 3 ? 1 : arm_m_);
  return Eigen::JacobiSVD<Eigen::MatrixXd>(rows).singularValues().minCoeff() > 0.05;
}

bool ThrustAllocation::gives(int axis) const {
  return std::find(axes_.begin(), axes_.end(), axis) != axes_.end();
}

double ThrustAllocation::allocate(const Wrench& wanted, Eigen::VectorXd& forces_N) const {
  forces_N = Eigen::VectorXd::Zero(effect_.cols());
  for (std::size_t i = 0; i < axes_.size(); ++i)
    forces_N += inverse_.col(static_cast<Eigen::Index>(i)) * wanted[axes_[i]];
  double scale = 1;
  for (Eigen::Index i = 0; i < forces_N.size(); ++i) {
    const ThrusterPlace& thruster = thrusters_[static_cast<std::size_t>(i)];
    const double limit = forces_N[i] > 0 ? thruster.max_N : thruster.min_N;
    if (std::abs(forces_N[i]) > std::abs(limit)) scale = std::min(scale, limit / forces_N[i]);
  }
  forces_N *= scale;
  return scale;
}

}  // namespace devices
