// SPDX-License-Identifier: BSD-3-Clause
#include <ode/ode.h>

#include "sim/ode/ode_math.hpp"
#include "sim/physics/joint.hpp"

namespace sim {

namespace {

/// Mass, inertia and position of a body in the world frame.
struct RigidMass {
  double mass_kg;
  Matrix3d inverse_inertia_W;
  Vector3d p_WC;
};

RigidMass rigid_mass(dBodyID body) {
  dMass mass;
  dBodyGetMass(body, &mass);
  Matrix3d inertia_C;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) inertia_C(row, column) = mass.I[row * 4 + column];
  const Pose X_WC = ode_pose(body);
  return {mass.mass, X_WC.linear() * inertia_C.inverse() * X_WC.linear().transpose(), X_WC.translation()};
}

}  // namespace

// The anchor keeps the two bodies together by an impulse p: the relative velocity of their points there,
// of_point p + shift, is 0.  The impulse changes the rate about the axis by shift . p.
double Joint::mobility(int axis) const {
  const Vector3d along = axis_W(axis);
  const Vector3d anchor = ode_pose(loaded_) * p_CA_C_;
  double push = 0, turn = 0;
  Vector3d shift = Vector3d::Zero();
  Matrix3d of_point = Matrix3d::Zero();
  for (const int side : {0, 1}) {
    const dBodyID body = dJointGetBody(ode_.get(), side);
    if (body == nullptr || dBodyIsKinematic(body) != 0) continue;
    const RigidMass mass = rigid_mass(body);
    const Vector3d arm = anchor - mass.p_WC;
    const Matrix3d cross = cross_matrix(arm);
    const Vector3d spin = mass.inverse_inertia_W * along;
    push += 1 / mass.mass_kg;
    turn += along.dot(spin);
    shift += spin.cross(arm);
    of_point += Matrix3d::Identity() / mass.mass_kg - cross * mass.inverse_inertia_W * cross;
  }
  if (type_ == JointType::slider) return push;
  // The suspension of hinge2 does not hold the anchor, and two fixed bodies have no mobility.
  if (type_ == JointType::hinge2 || push == 0) return turn;
  return turn - shift.dot(of_point.ldlt().solve(shift));
}

}  // namespace sim
