// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include "sim/base/math.hpp"

namespace sim {

inline Vector3d to_eigen(const dReal* v) {
  return {v[0], v[1], v[2]};
}

/// Rotation matrix from ODE's 3x4 row-major layout.
inline Matrix3d rotation_to_eigen(const dReal* R) {
  Matrix3d out;
  out << R[0], R[1], R[2], R[4], R[5], R[6], R[8], R[9], R[10];
  return out;
}

/// Writes a rotation in ODE's 3x4 row-major layout.
inline void to_ode(const Matrix3d& R, dMatrix3 out) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) out[4 * row + column] = R(row, column);
    out[4 * row + 3] = 0;
  }
}

/// Writes a quaternion in ODE's order: w, x, y, z.
inline void to_ode(const Quaterniond& q, dQuaternion out) {
  out[0] = q.w();
  out[1] = q.x();
  out[2] = q.y();
  out[3] = q.z();
}

/// Unit quaternion of a rotation.  Eigen's conversion is exact for the identity, which keeps level bodies level to the
/// last bit.
inline Quaterniond to_quaternion(const Matrix3d& R) {
  return Quaterniond(R).normalized();
}

/// Pose of ODE's frame of a body, with its origin at the center of mass.
inline Pose ode_pose(dBodyID body) {
  Pose X_WC = Pose::Identity();
  X_WC.linear() = rotation_to_eigen(dBodyGetRotation(body));
  X_WC.translation() = to_eigen(dBodyGetPosition(body));
  return X_WC;
}

}  // namespace sim
