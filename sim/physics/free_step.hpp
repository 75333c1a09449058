// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "sim/base/math.hpp"

// The step of a body that touches nothing, of second order: position by the mean of the velocities before and after,
// attitude by the Cayley map of the mean angular velocity, velocities by the forces half-way.  The rotation without
// torque is the implicit midpoint rule on the group of rotations: it keeps the energy and the angular momentum, also
// its direction, to rounding (Simo & Wong 1991, Int. J. Numer. Meth. Engng. 31, 19-52; Lewis & Simo 1994, J. Nonlinear
// Sci. 4, 253-299).

namespace sim {

/// Rotation over a step with this angular velocity: of angle 2 atan(|w| h / 2), which is the Cayley map
/// (I - h/2 [w])^-1 (I + h/2 [w]) as a quaternion.
inline Eigen::Quaterniond cayley(const Vector3d& w_radps, double step_s) {
  const Vector3d half = 0.5 * step_s * w_radps;
  return Eigen::Quaterniond(1, half.x(), half.y(), half.z()).normalized();
}

/// Returns the angular velocity after a step under a torque that is constant in axes of the body, by the implicit
/// midpoint rule for I w' + w x I w = torque.  All in axes of the body; inertia in kg m^2.  Nothing when the rotation
/// is too fast for the step, so that Newton's method fails.
std::optional<Vector3d> angular_velocity_after(const Matrix3d& inertia_kgm2, const Vector3d& w_radps,
                                               const Vector3d& torque_Nm, double step_s);

}  // namespace sim
