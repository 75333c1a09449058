// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/crowd_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "sim/ode/ode_math.hpp"

namespace sim {

namespace {

constexpr int rounds = 8;
/// Contacts whose normal is steeper than this carry weight.
constexpr double max_up = 0.3;

Vector3d velocity_of(dBodyID body, const Vector3d& p_W) {
  return to_eigen(dBodyGetLinearVel(body)) +
         to_eigen(dBodyGetAngularVel(body)).cross(p_W - to_eigen(dBodyGetPosition(body)));
}

}  // namespace

bool CrowdContacts::can_solve(const dContact& contact) {
  return std::abs(contact.geom.normal[2]) < max_up &&
         (contact.surface.mode & (dContactRolling | dContactSlip1 | dContactSlip2 | dContactMotionN)) == 0;
}

void CrowdContacts::clear() {
  vehicles_.clear();
  numbers_.clear();
  of_body_.clear();
  contacts_.clear();
}

void CrowdContacts::add_body(dBodyID ode, double mass_kg, const Matrix3d& inertia_C_B, int vehicle) {
  const auto [at, is_new] = numbers_.try_emplace(vehicle, static_cast<int>(vehicles_.size()));
  if (is_new) vehicles_.emplace_back();
  Vehicle& whole = vehicles_[static_cast<std::size_t>(at->second)];
  whole.mass_kg += mass_kg;
  whole.p_WC += mass_kg * to_eigen(dBodyGetPosition(ode));
  whole.bodies.push_back({ode, mass_kg, inertia_C_B});
  of_body_[ode] = at->second;
}

/// Index of a vehicle; -1: the body is kinematic.
int CrowdContacts::vehicle_of(dBodyID body) const {
  const auto at = of_body_.find(body);
  return at == of_body_.end() ? -1 : at->second;
}

void CrowdContacts::add_contact(const Collider::Between& contact) {
  Contact& added = contacts_.emplace_back();
  added.between = &contact;
  for (const int end : {0, 1}) added.vehicles[end] = vehicle_of(contact.bodies[end]);
}

/// The vehicle as one rigid body, and what the forces on it change in the step.
void CrowdContacts::find_motion(Vehicle& vehicle) const {
  vehicle.p_WC /= vehicle.mass_kg;
  vehicle.inverse_mass = 1 / vehicle.mass_kg;
  Matrix3d inertia_W = Matrix3d::Zero();
  Vector3d force_W = Vector3d::Zero(), torque_W = Vector3d::Zero();
  for (const Member& body : vehicle.bodies) {
    const Matrix3d R_WB = rotation_to_eigen(dBodyGetRotation(body.ode));
    const Vector3d arm_W = to_eigen(dBodyGetPosition(body.ode)) - vehicle.p_WC;
    inertia_W += R_WB * body.inertia_C_B * R_WB.transpose() +
                 body.mass_kg * (arm_W.squaredNorm() * Matrix3d::Identity() - arm_W * arm_W.transpose());
    const Vector3d force_i_W = to_eigen(dBodyGetForce(body.ode));
    force_W += force_i_W;
    torque_W += to_eigen(dBodyGetTorque(body.ode)) + arm_W.cross(force_i_W);
  }
  vehicle.inverse_inertia_W = inertia_W.inverse();
  vehicle.dv_W = settings_.step_s * vehicle.inverse_mass * force_W;
  vehicle.dw_W = settings_.step_s * (vehicle.inverse_inertia_W * torque_W);
}

void CrowdContacts::find_rows(Contact& contact) {
  const double h = settings_.step_s;
  const dContact& made = contact.between->contact;
  const Vector3d p_W = to_eigen(made.geom.pos);
  contact.cfm_ph = (made.surface.mode & dContactSoftCFM ? made.surface.soft_cfm : settings_.cfm) / h;
  contact.rows[0].along_W = to_eigen(made.geom.normal);
  contact.rows[1].along_W = contact.rows[0].along_W.unitOrthogonal();
  contact.rows[2].along_W = contact.rows[0].along_W.cross(contact.rows[1].along_W);
  contact.rows[0].inverse_mass = contact.cfm_ph;
  const Vector3d relative_W =
      velocity_of(contact.between->bodies[0], p_W) - velocity_of(contact.between->bodies[1], p_W);
  for (Row& row : contact.rows) row.approach_mps = row.along_W.dot(relative_W);
  for (const int end : {0, 1}) {
    const bool moves = contact.vehicles[end] >= 0;
    if (!moves) contact.vehicles[end] = static_cast<int>(vehicles_.size()) - 1;
    const Vehicle& vehicle = vehicles_[static_cast<std::size_t>(contact.vehicles[end])];
    for (Row& row : contact.rows) {
      row.levers_W[end] = moves ? (p_W - vehicle.p_WC).cross(row.along_W) : Vector3d(Vector3d::Zero());
      row.turns_W[end] = vehicle.inverse_inertia_W * row.levers_W[end];
      row.inverse_mass += vehicle.inverse_mass + row.levers_W[end].dot(row.turns_W[end]);
    }
  }
  // Depth is corrected as by ODE, and fast contacts bounce.
  const double erp = made.surface.mode & dContactSoftERP ? made.surface.soft_erp : settings_.erp;
  const double depth_m = std::max(0.0, made.geom.depth - settings_.surface_layer_m);
  contact.desired_mps = std::min(erp / h * depth_m, settings_.max_correcting_velocity_mps);
  const double approach_mps = rate_mps(contact, contact.rows[0]);
  if ((made.surface.mode & dContactBounce) && -approach_mps > made.surface.bounce_vel)
    contact.desired_mps = std::max(contact.desired_mps, -made.surface.bounce * approach_mps);
}

double CrowdContacts::rate_mps(const Contact& contact, const Row& row) const {
  const Vehicle& a = vehicles_[static_cast<std::size_t>(contact.vehicles[0])];
  const Vehicle& b = vehicles_[static_cast<std::size_t>(contact.vehicles[1])];
  return row.approach_mps + row.along_W.dot(a.dv_W - b.dv_W) + row.levers_W[0].dot(a.dw_W) -
         row.levers_W[1].dot(b.dw_W);
}

void CrowdContacts::push(const Contact& contact, Row& row, double impulse_Ns) {
  Vehicle& a = vehicles_[static_cast<std::size_t>(contact.vehicles[0])];
  Vehicle& b = vehicles_[static_cast<std::size_t>(contact.vehicles[1])];
  a.dv_W += impulse_Ns * a.inverse_mass * row.along_W;
  a.dw_W += impulse_Ns * row.turns_W[0];
  b.dv_W -= impulse_Ns * b.inverse_mass * row.along_W;
  b.dw_W -= impulse_Ns * row.turns_W[1];
  row.impulse_Ns += impulse_Ns;
}

void CrowdContacts::iterate(Contact& contact) {
  Row& normal = contact.rows[0];
  const double missing_mps = contact.desired_mps - rate_mps(contact, normal) - contact.cfm_ph * normal.impulse_Ns;
  push(contact, normal, std::max(-normal.impulse_Ns, missing_mps / normal.inverse_mass));
  // Friction, within Coulomb's cone.
  Eigen::Vector2d friction_Ns;
  for (const int axis : {0, 1}) {
    const Row& row = contact.rows[axis + 1];
    friction_Ns[axis] = row.impulse_Ns - rate_mps(contact, row) / row.inverse_mass;
  }
  const double max_Ns = contact.between->contact.surface.mu * normal.impulse_Ns, norm_Ns = friction_Ns.norm();
  if (norm_Ns > max_Ns) friction_Ns *= max_Ns / norm_Ns;
  for (const int axis : {0, 1})
    push(contact, contact.rows[axis + 1], friction_Ns[axis] - contact.rows[axis + 1].impulse_Ns);
}

void CrowdContacts::add_force(const Contact& contact) const {
  Vector3d force_W = Vector3d::Zero();
  for (const Row& row : contact.rows) force_W += row.impulse_Ns / settings_.step_s * row.along_W;
  const dReal* const p = contact.between->contact.geom.pos;
  for (const int end : {0, 1}) {
    const Vector3d on_end_W = end == 0 ? force_W : Vector3d(-force_W);
    if (vehicles_[static_cast<std::size_t>(contact.vehicles[end])].mass_kg > 0)
      dBodyAddForceAtPos(contact.between->bodies[end], on_end_W.x(), on_end_W.y(), on_end_W.z(), p[0], p[1], p[2]);
  }
  if (dJointFeedback* const feedback = dJointGetFeedback(contact.between->joint)) {
    *feedback = {};
    for (int i = 0; i < 3; ++i) {
      feedback->f1[i] = force_W[i];
      feedback->f2[i] = -force_W[i];
    }
  }
}

void CrowdContacts::solve() {
  for (Vehicle& vehicle : vehicles_) find_motion(vehicle);
  vehicles_.emplace_back();  // in the place of kinematic bodies: does not move
  for (Contact& contact : contacts_) find_rows(contact);
  for (int round = 0; round < rounds; ++round)
    for (Contact& contact : contacts_) iterate(contact);
  for (const Contact& contact : contacts_) add_force(contact);
}

}  // namespace sim
