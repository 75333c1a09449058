// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/base/math.hpp"

namespace devices {

/// Force and torque: surge, sway, heave along x, y, z, and roll, pitch, yaw about them.
using Wrench = Eigen::Matrix<double, 6, 1>;

/// The YAML names of the six axes of a wrench, in its order.
const std::vector<std::string>& wrench_axes();

/// One thruster as the allocation sees it; it pushes along +x of its frame T.
struct ThrusterPlace {
  sim::Pose X_ST = sim::Pose::Identity();
  double max_N = 0;   ///< > 0
  double min_N = 0;   ///< <= 0
  double weight = 1;  ///< cost of its force squared: 2 takes it half as much as 1
};

/// Shares a wrench among thrusters: the least weighted sum of squares that gives the wrench on the axes that count
/// (Fossen 2021, equation 11.35: f = W^-1 B^T (B W^-1 B^T)^-1 tau).
class ThrustAllocation {
 public:
  /// `axes`: numbers of the axes that count; empty: as many as the thrusters can give, looked at in the order surge,
  /// yaw, heave, sway, roll, pitch.  Throws std::invalid_argument where the thrusters cannot give them all.
  ThrustAllocation(std::vector<ThrusterPlace> thrusters, const std::vector<int>& axes);

  /// Forces of the thrusters, N.  What is asked of a thruster the way in which it cannot push is dropped, and the
  /// others come as near to the wrench as they can.  Where one would be over its limit all are scaled by one number, so
  /// that the direction of the wrench stays.  The share of the wrench that they give is returned: 1 when nothing was
  /// dropped or is over.
  double allocate(const Wrench& desired, Eigen::VectorXd& forces_N) const;
  /// What such forces give together.
  Wrench wrench_of(const Eigen::VectorXd& forces_N) const { return effect_ * forces_N; }
  bool gives(int axis) const;
  const std::vector<int>& axes() const { return axes_; }

 private:
  bool controllable(const std::vector<int>& axes) const;
  bool cannot_push(Eigen::Index thruster, double force_N) const;
  double nearest(const Wrench& desired, std::vector<bool> dropped, Eigen::VectorXd& forces_N) const;

  std::vector<ThrusterPlace> thrusters_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> effect_;  // wrench of a unit force of each
  double arm_m_ = 1;
  std::vector<int> axes_;
  Eigen::MatrixXd inverse_;  // thrusters x axes
};

}  // namespace devices
