// SPDX-License-Identifier: BSD-3-Clause
#include "python/world/vehicle_motion.hpp"

#include <Eigen/Geometry>

namespace python {

Motion motion_of(const sim::Vehicle& vehicle) {
  const sim::Pose X_WV = vehicle.X_WV();
  const sim::Body& base = vehicle.base();
  const sim::Vector3d p_BV = base.X_WB().inverse() * X_WV.translation();
  const Eigen::Quaterniond q(X_WV.linear());
  // q and -q are the same attitude; one of them is chosen, so that observations do not jump.
  const double sign = q.w() < 0 ? -1 : 1;
  Motion motion{};
  Eigen::Map<sim::Vector3d>(motion.position_m) = X_WV.translation();
  Eigen::Map<Eigen::Vector4d>(motion.orientation) = sign * Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  Eigen::Map<sim::Vector3d>(motion.velocity_mps) = base.velocity_at_W(p_BV);
  Eigen::Map<sim::Vector3d>(motion.rates_radps) = X_WV.linear().transpose() * base.w_WB_W();
  return motion;
}

}  // namespace python
