// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/free_step.hpp"

namespace sim {

namespace {

/// Solves [a b c] x = r by Cramer's rule; far cheaper here than a general inverse.
Vector3d solve(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& r) {
  const Vector3d b_c = b.cross(c);
  return Vector3d(r.dot(b_c), a.dot(r.cross(c)), a.dot(b.cross(r))) / a.dot(b_c);
}

}  // namespace

std::optional<Vector3d> angular_velocity_after(const Matrix3d& inertia_kgm2, const Vector3d& w,
                                               const Vector3d& torque_Nm, double step_s) {
  const Vector3d I_x = inertia_kgm2.col(0), I_y = inertia_kgm2.col(1), I_z = inertia_kgm2.col(2);
  const auto times_inertia = [&](const Vector3d& v) -> Vector3d { return v.x() * I_x + v.y() * I_y + v.z() * I_z; };
  const Vector3d momentum = times_inertia(w);
  const double h = step_s;
  // A body at rest, or in rotation about a principal axis, without torque.
  constexpr double negligible = 1e-10;
  if (torque_Nm.isZero(0) &&
      h * h * w.cross(momentum).squaredNorm() <= negligible * negligible * momentum.squaredNorm())
    return w;
  Vector3d next = w;
  for (int i = 0; i < 4; ++i) {  // Newton's method for the angular velocity at the end of the step
    const Vector3d mid = (w + next) / 2;
    const Vector3d I_mid = times_inertia(mid);
    const Vector3d residual = times_inertia(next - w) + h * (mid.cross(I_mid) - torque_Nm);
    // Columns of the Jacobian I + h/2 ([mid] I - [I mid]).
    const Vector3d a = I_x + h / 2 * (mid.cross(I_x) - I_mid.cross(Vector3d::UnitX()));
    const Vector3d b = I_y + h / 2 * (mid.cross(I_y) - I_mid.cross(Vector3d::UnitY()));
    const Vector3d c = I_z + h / 2 * (mid.cross(I_z) - I_mid.cross(Vector3d::UnitZ()));
    const Vector3d change = solve(a, b, c, residual);
    next -= change;
    if (change.squaredNorm() <= 1e-16 * next.squaredNorm()) break;  // the next change would be below rounding
  }
  if (!next.allFinite()) return std::nullopt;
  return next;
}

}  // namespace sim
