// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/base/math.hpp"

namespace devices {

/// Force and torque: surge, sway, heave along x, y, z, and roll, pitch, yaw about them.
using Wrench = Eigen::Matrix<double, 6, 1>;

/// Returns the YAML names of the six axes of a wrench, in its order.
const std::vector<std::string>& wrench_axes();

/// Pose and limits of a thruster for the allocation.  Its force acts along +x of its frame T.
struct ThrusterPlace {
  sim::Pose X_ST = sim::Pose::Identity();
  double max_N = 0;   ///< > 0
  double min_N = 0;   ///< <= 0
  double weight = 1;  ///< weight of its squared force in the cost; 2 halves its use
};

/// Allocates a wrench to thrusters: the forces with the least weighted sum of squares that produce the wrench on the
/// controlled axes (Fossen 2021, equation 11.35: f = W^-1 B^T (B W^-1 B^T)^-1 tau).
class ThrustAllocation {
 public:
  /// `axes`: indices of the controlled axes; empty: as many as the thrusters can control, tried in the order surge,
  /// yaw, heave, sway, roll, pitch.  Throws std::invalid_argument when the thrusters cannot control all of them.
  ThrustAllocation(std::vector<ThrusterPlace> thrusters, const std::vector<int>& axes);

  /// Computes the forces of the thrusters, N.  Thrusters that cannot push in the required direction are dropped, and
  /// the others approximate the wrench in the least-squares sense.  When a force exceeds its limit, the forces for
  /// roll and pitch are given first, since a craft that turns over is lost; all others are scaled by one factor, which
  /// preserves the direction of the rest of the wrench.  Returns the share of the wrench that is produced: 1 without
  /// drops and saturation.
  double allocate(const Wrench& desired, Eigen::VectorXd& forces_N) const;
  /// Returns the wrench of the given forces.
  Wrench wrench_of(const Eigen::VectorXd& forces_N) const { return effect_ * forces_N; }
  /// Returns true when an axis is controlled.
  bool gives(int axis) const;
  const std::vector<int>& axes() const { return axes_; }

 private:
  bool controllable(const std::vector<int>& axes) const;
  bool cannot_push(Eigen::Index thruster, double force_N) const;
  double possible_share(const Eigen::VectorXd& first_N, const Eigen::VectorXd& then_N) const;
  double nearest(const Wrench& desired, std::vector<bool> dropped, Eigen::VectorXd& forces_N) const;

  std::vector<ThrusterPlace> thrusters_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> effect_;  // wrench of a unit force, column by thruster
  double arm_m_ = 1;                                 // root mean square of lever arms, to scale torques
  std::vector<int> axes_;
  Eigen::MatrixXd inverse_;  // thrusters x axes
};

}  // namespace devices
