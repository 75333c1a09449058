// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/stepped_body.hpp"

#include "sim/base/math.hpp"
#include "sim/config/message_text.hpp"
#include "sim/ode/body_copy.hpp"

namespace sim {

namespace {

/// Mass, center of mass and inertia given in a body's hydrodynamics, in body axes.
dMass published_mass(const HydrodynamicsConfig& config) {
  const auto flip = [](int i) { return i == 0 ? 1.0 : -1.0; };  // forward-right-down to forward-left-up
  dMass mass;
  dMassSetZero(&mass);
  mass.mass = config.mass_kg;
  const Vector3d& c = config.center_of_mass_m;
  const Matrix3d about_origin =
      config.inertia_kgm2 + config.mass_kg * (c.squaredNorm() * Matrix3d::Identity() - c * c.transpose());
  for (int i = 0; i < 3; ++i) {
    mass.c[i] = flip(i) * c[i];
    for (int j = 0; j < 3; ++j) mass.I[4 * i + j] = flip(i) * flip(j) * about_origin(i, j);
  }
  return mass;
}

}  // namespace

void SteppedBody::create(dWorldID world) {
  const dBodyID ode = dBodyCreate(world);
  dBodySetData(ode, this);
  ode_.reset(ode);
  const auto writable = [](const dReal* of_ode) { return const_cast<dReal*>(of_ode); };
  p_WC_ = writable(dBodyGetPosition(ode));
  q_WB_ = writable(dBodyGetQuaternion(ode));
  R_WB_ = writable(dBodyGetRotation(ode));
  v_WC_W_ = writable(dBodyGetLinearVel(ode));
  w_WB_W_ = writable(dBodyGetAngularVel(ode));
  force_N_ = writable(dBodyGetForce(ode));
  torque_Nm_ = writable(dBodyGetTorque(ode));
  // Replaced by Body::add_gyroscopic_torque.
  dBodySetGyroscopicMode(ode, 0);
  if (!kinematic()) return;
  gyroscopic_ = false;
  dBodySetKinematic(ode);
  dBodySetGravityMode(ode, 0);
  // Makes a step rotate the body by exactly its angular velocity.
  dBodySetFiniteRotationMode(ode, 1);
}

BodyHandle SteppedBody::create_again(dWorldID world) {
  BodyHandle before = std::move(ode_);
  const dBodyID old = before.get();
  create(world);
  const dBodyID ode = ode_.get();
  if (free()) {
    dMass mass;
    dBodyGetMass(old, &mass);
    dBodySetMass(ode, &mass);
  }
  dBodySetGravityMode(ode, dBodyGetGravityMode(old));
  dBodySetFiniteRotationMode(ode, dBodyGetFiniteRotationMode(old));
  BodyCopy(old).write_to(ode);
  if (!dBodyIsEnabled(old)) dBodyDisable(ode);
  return before;
}

void SteppedBody::set_mass(const BodyConfig& config, const dMass& of_parts) {
  const bool published = config.hydrodynamics && config.hydrodynamics->mass_kg > 0;
  dMass mass = published ? published_mass(*config.hydrodynamics) : of_parts;
  const SourcePlace& place = config.parts.empty() ? config.place : config.parts.front().place;
  if (!(mass.mass > 0))
    throw_config_error(place, "body '" + name() + "'", "has no mass: give a part mass_kg or density_kgpm3");
  // Move the inertia to the center of mass.
  mass_kg_ = mass.mass;
  p_BC_ = to_eigen(mass.c);
  dMassTranslate(&mass, -mass.c[0], -mass.c[1], -mass.c[2]);
  mass.c[0] = mass.c[1] = mass.c[2] = 0;  // exactly, or ODE aborts
  inertia_C_B_ = rotation_to_eigen(mass.I);
  // With equal moments, as of spheres and cubes, the gyroscopic torque is zero.
  const double mean = inertia_C_B_.trace() / 3;
  gyroscopic_ = !inertia_C_B_.isApprox(mean * Matrix3d::Identity(), 1e-12);
  // Check the range in which ODE can invert the inertia; ODE's own error would not name the body.
  const Vector3d moments = symmetric_eigenvalues(inertia_C_B_);
  const bool solvable = mass.mass < 1e30 && moments.minCoeff() > 1e-60 && moments.maxCoeff() < 1e60;
  if (!solvable)
    throw_config_error(place, "body '" + name() + "'",
                       "its moments of inertia must be above 1e-60 and below 1e60 kg m2, got " +
                           number_text(moments.minCoeff()) + " to " + number_text(moments.maxCoeff()) + " with " +
                           number_text(mass.mass) + " kg");
  dBodySetMass(ode_.get(), &mass);
}

void SteppedBody::add_geom(dGeomID geom, const PartConfig& part, const Pose& X_BG) {
  if (fixed()) {
    fixed_geoms_.push_back({geom, X_BG, part.shape == PartShape::plane});
    return;
  }
  // A zero offset would still cost a matrix product in each step.
  const Vector3d p_CG = X_BG.translation() - p_BC_;
  dGeomSetBody(geom, ode_.get());
  if (!p_CG.isZero(0)) dGeomSetOffsetPosition(geom, p_CG.x(), p_CG.y(), p_CG.z());
  dQuaternion q;
  to_ode(to_quaternion(X_BG.linear()), q);
  if (!part.rpy_rad.isZero(0)) dGeomSetOffsetQuaternion(geom, q);
}

CollisionBody SteppedBody::for_collider() const {
  return {free(), ode_.get(), p_WC_, v_WC_W_, w_WB_W_, mass_kg_ > 0 ? 1 / mass_kg_ : 0};
}

}  // namespace sim
