// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/body.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <span>
#include <type_traits>

#include "sim/ode/ode_math.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/physics/free_step.hpp"
#include "sim/rays/ode_scene.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

static_assert(std::is_same_v<dReal, double>, "Body keeps pointers into ODE's numbers");

namespace {

void store(double* to, const Vector3d& v) {
  to[0] = v.x();
  to[1] = v.y();
  to[2] = v.z();
}

}  // namespace

void BodyDeleter::operator()(dxBody* body) const {
  dBodyDestroy(body);
}

Pose Body::X_WB() const {
  if (fixed()) return seat_X_WB_;
  Pose X_WB = Pose::Identity();
  X_WB.linear() = rotation_to_eigen(R_WB_);
  X_WB.translation() = to_eigen(p_WC_) - X_WB.linear() * p_BC_;
  return X_WB;
}

Vector3d Body::p_WB() const {
  if (fixed()) return seat_X_WB_.translation();
  return to_eigen(p_WC_) - rotation_to_eigen(R_WB_) * p_BC_;
}

Vector3d Body::v_WB_W() const {
  return velocity_at_W(Vector3d::Zero());
}

Vector3d Body::w_WB_W() const {
  return fixed() ? Vector3d(Vector3d::Zero()) : to_eigen(w_WB_W_);
}

// The functions of each step are flattened: otherwise small functions of Eigen are calls.
[[gnu::flatten]] BodyMotion Body::motion() const {
  if (fixed()) return {seat_X_WB_.linear(), seat_X_WB_.translation(), Vector3d::Zero(), Vector3d::Zero()};
  BodyMotion motion{rotation_to_eigen(R_WB_)};
  const Vector3d p_BC_W = motion.R_WB * p_BC_;
  motion.p_WB = to_eigen(p_WC_) - p_BC_W;
  motion.w_WB_W = to_eigen(w_WB_W_);
  motion.v_WB_W = to_eigen(v_WC_W_) - motion.w_WB_W.cross(p_BC_W);
  return motion;
}

Vector3d Body::velocity_at_W(const Vector3d& p_B) const {
  if (fixed()) return Vector3d::Zero();
  const Vector3d p_CP_W = rotation_to_eigen(R_WB_) * (p_B - p_BC_);
  return to_eigen(v_WC_W_) + to_eigen(w_WB_W_).cross(p_CP_W);
}

void Body::add_force_W(const Vector3d& force_N, const Vector3d& at_W) {
  // Checked before the call of ODE, which would abort later in the step without the name of the body.
  if (!force_N.allFinite() || !at_W.allFinite())
    throw PhysicsFault("body '" + name_ + "': a force on it is not finite");
  if (!free()) return;
  dBodyAddForceAtPos(ode_.get(), force_N.x(), force_N.y(), force_N.z(), at_W.x(), at_W.y(), at_W.z());
}

void Body::add_torque_W(const Vector3d& torque_Nm) {
  if (!torque_Nm.allFinite()) throw PhysicsFault("body '" + name_ + "': a torque on it is not finite");
  if (!free()) return;
  store(torque_Nm_, to_eigen(torque_Nm_) + torque_Nm);
}

Vector3d Body::applied_force_W() const {
  return free() ? to_eigen(force_N_) : Vector3d(Vector3d::Zero());
}

Vector3d Body::applied_torque_W() const {
  return free() ? to_eigen(torque_Nm_) : Vector3d(Vector3d::Zero());
}

void Body::set_applied_W(const Vector3d& force_N, const Vector3d& torque_Nm) {
  if (!force_N.allFinite() || !torque_Nm.allFinite())
    throw PhysicsFault("body '" + name_ + "': the forces of the water on it are not finite");
  if (!free()) return;
  store(force_N_, force_N);
  store(torque_Nm_, torque_Nm);
}

void Body::set_pose(const Pose& X_WB) {
  if (!X_WB.matrix().allFinite()) throw PhysicsFault("body '" + name_ + "': its new pose is not finite");
  if (fixed()) {
    ++moves_->fixed;
    seat_X_WB_ = X_WB;
    place_fixed_geoms();
    return;
  }
  ++moves_->moving;
  ++moves_->jumps;
  if (kinematic()) {
    seat_X_WB_ = X_WB;
    end_kinematic_step();
    start_kinematic_step();
  } else {
    place_ode_body(X_WB);
  }
}

void Body::place_ode_body(const Pose& X_WB) {
  const Vector3d p_WC = X_WB * p_BC_;
  dQuaternion q;
  to_ode(to_quaternion(X_WB.linear()), q);
  dBodySetPosition(ode_.get(), p_WC.x(), p_WC.y(), p_WC.z());
  dBodySetQuaternion(ode_.get(), q);
}

void Body::move_to(const Pose& X_WB_at_end, double step_s) {
  if (!X_WB_at_end.matrix().allFinite() || !(step_s > 0))
    throw PhysicsFault("body '" + name_ + "': the pose it is moved to is not finite");
  assert(kinematic());
  const Vector3d v_WB_W = (X_WB_at_end.translation() - to_eigen(p_WC_)) / step_s;
  const Eigen::AngleAxisd turn_W(to_quaternion(X_WB_at_end.linear() * rotation_to_eigen(R_WB_).transpose()));
  const Vector3d w_WB_W = turn_W.angle() / step_s * turn_W.axis();
  move_to(X_WB_at_end, v_WB_W, w_WB_W);
}

[[gnu::flatten]] void Body::move_to(const Pose& X_WB_at_end, const Vector3d& v_WB_W, const Vector3d& w_WB_W) {
  assert(kinematic());
  store(v_WC_W_, v_WB_W);
  store(w_WB_W_, w_WB_W);
  // The first three columns, by their bits: -0 and 0 give attitudes of other bits.
  turn_is_due_ |= std::memcmp(seat_X_WB_.data(), X_WB_at_end.data(), 3 * 4 * sizeof(double)) != 0;
  seat_X_WB_ = X_WB_at_end;
  move_is_due_ = true;
}

void Body::start_kinematic_step() {
  if (move_is_due_) return;
  store(v_WC_W_, Vector3d::Zero());
  store(w_WB_W_, Vector3d::Zero());
}

/// Sets the exact target pose.  ODE reaches it except for rounding, which would accumulate, also in a body at rest: ODE
/// normalizes the quaternion in each step, and that is not idempotent.
void Body::end_kinematic_step() {
  place_ode_body(seat_X_WB_);
  move_is_due_ = turn_is_due_ = false;
  // Disabled bodies cost less: ODE still steps one in contact with a free body.
  dBodyDisable(ode_.get());
}

/// The same after a step without ODE, in which the body kept its pose.  Its parts are not marked as moved.
[[gnu::flatten]] void Body::end_kinematic_step_alone() {
  if (move_is_due_) store(p_WC_, seat_X_WB_ * p_BC_);
  if (turn_is_due_) write_rotation(to_quaternion(seat_X_WB_.linear()));
  move_is_due_ = turn_is_due_ = false;
}

void Body::set_velocity_W(const Vector3d& v_WB_W, const Vector3d& w_WB_W) {
  if (!v_WB_W.allFinite() || !w_WB_W.allFinite())
    throw PhysicsFault("body '" + name_ + "': its new velocity is not finite");
  if (!free()) return;
  const Vector3d v_WC_W = v_WB_W + w_WB_W.cross(rotation_to_eigen(R_WB_) * p_BC_);
  store(v_WC_W_, v_WC_W);
  store(w_WB_W_, w_WB_W);
  a_WC_W_.setZero();
  alpha_B_.setZero();
  last_step_ = LastStep::none;
}

void Body::set_gravity(bool on) {
  gravity_ = on;
  if (free()) dBodySetGravityMode(ode_.get(), on);
}

namespace {

/// Whether all numbers are finite and can be squared; otherwise ODE aborts within a step.
bool is_usable(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::abs(number) < 1e30; });
}

/// Tolerance of a restored rotation.  Rounding errors are far smaller, as ODE normalizes in each step.
constexpr double rotation_tolerance = 1e-6;

bool is_rotation(const Matrix3d& R) {
  return (R.transpose() * R - Matrix3d::Identity()).cwiseAbs().maxCoeff() < rotation_tolerance && R.determinant() > 0;
}

bool is_pose(const Pose& X) {
  return is_usable({X.matrix().data(), 16}) && is_rotation(X.linear());
}

}  // namespace

// ODE's setters normalize the quaternion, which is not idempotent: a restored world would differ in the last bits.  The
// numbers are therefore written directly into ODE's memory; dBodySetPosition then marks the geoms as moved.
void Body::visit_state(StateArchive& archive) {
  if (fixed()) {
    Pose X_WB = seat_X_WB_;
    archive(X_WB);
    if (archive.restoring() && !is_pose(X_WB)) archive.fail("'" + name_ + "' has an invalid pose");
    if (archive.restoring() && X_WB.matrix() != seat_X_WB_.matrix()) set_pose(X_WB);
    return;
  }
  struct {
    double p_WC[3], q_WB[4], R_WB[12], v_WC_W[3], w_WB_W[3];
  } motion;
  struct {
    double force_N[3], torque_Nm[3];
    Pose::MatrixType seat_X_WB;
    Vector3d a_WC_W, alpha_B;
    bool enabled, move_is_due;
    LastStep last_step;
  } rest = {};
  // Copy the motion out of ODE, and visit it as one block.
  const auto each = [&](const auto& copy) {
    copy(motion.p_WC, p_WC_, 3);
    copy(motion.q_WB, q_WB_, 4);
    copy(motion.R_WB, R_WB_, 12);
    copy(motion.v_WC_W, v_WC_W_, 3);
    copy(motion.w_WB_W, w_WB_W_, 3);
  };
  each([](double* to, const double* from, int count) { std::copy_n(from, count, to); });
  archive.raw(&motion, sizeof motion);
  // Visit the applied forces, and the target pose of a kinematic body.
  std::copy_n(force_N_, 3, rest.force_N);
  std::copy_n(torque_Nm_, 3, rest.torque_Nm);
  rest.seat_X_WB = seat_X_WB_.matrix();
  rest.enabled = dBodyIsEnabled(ode_.get());
  rest.move_is_due = move_is_due_;
  rest.a_WC_W = a_WC_W_;
  rest.alpha_B = alpha_B_;
  rest.last_step = last_step_;
  archive.unhashed(rest.force_N, rest.torque_Nm, rest.enabled, rest.move_is_due, rest.a_WC_W, rest.alpha_B,
                   rest.last_step);
  if (kinematic()) archive.unhashed(rest.seat_X_WB);
  if (!archive.restoring()) return;
  // Check the restored numbers.
  const Eigen::Map<const Eigen::Vector4d> q_WB(motion.q_WB);
  Pose seat_X_WB = Pose::Identity();
  seat_X_WB.matrix() = rest.seat_X_WB;
  if (!is_usable(motion.p_WC) || !is_usable(motion.R_WB) || !is_rotation(rotation_to_eigen(motion.R_WB)) ||
      !(std::abs(q_WB.norm() - 1) < rotation_tolerance) || (kinematic() && !is_pose(seat_X_WB)))
    archive.fail("'" + name_ + "' has an invalid pose");
  if (!is_usable(motion.v_WC_W) || !is_usable(motion.w_WB_W) || !is_usable(rest.force_N) ||
      !is_usable(rest.torque_Nm) || !is_usable({rest.a_WC_W.data(), 3}) || !is_usable({rest.alpha_B.data(), 3}))
    archive.fail("'" + name_ + "' has an invalid velocity or force");
  // Write them back into ODE.
  each([](const double* from, double* to, int count) { std::copy_n(from, count, to); });
  dBodySetPosition(ode_.get(), motion.p_WC[0], motion.p_WC[1], motion.p_WC[2]);
  ++moves_->jumps;
  std::copy_n(rest.force_N, 3, force_N_);
  std::copy_n(rest.torque_Nm, 3, torque_Nm_);
  rest.enabled ? dBodyEnable(ode_.get()) : dBodyDisable(ode_.get());
  seat_X_WB_.matrix() = rest.seat_X_WB;
  move_is_due_ = rest.move_is_due;
  turn_is_due_ = kinematic();
  a_WC_W_ = rest.a_WC_W;
  alpha_B_ = rest.alpha_B;
  last_step_ = free() && rest.last_step <= LastStep::ode ? rest.last_step : LastStep::none;
}

void Body::place_fixed_geoms() {
  for (const FixedGeom& fixed_geom : fixed_geoms_) {
    const Pose X_WG = seat_X_WB_ * fixed_geom.X_BG;
    const Vector3d p = X_WG.translation();
    if (fixed_geom.plane) {
      const Vector3d normal_W = X_WG.linear().col(2);
      dGeomPlaneSetParams(fixed_geom.geom, normal_W.x(), normal_W.y(), normal_W.z(), normal_W.dot(p));
    } else {
      dQuaternion q;
      to_ode(to_quaternion(X_WG.linear()), q);
      dGeomSetPosition(fixed_geom.geom, p.x(), p.y(), p.z());
      dGeomSetQuaternion(fixed_geom.geom, q);
    }
  }
}

// The torque makes ODE's step reach the angular velocity of the implicit midpoint rule.  ODE's own gyroscopic term is
// an implicit Euler step with numerical damping: a body tumbling at 10 rad/s lost 11 % of its energy in 10 s.  Without
// any such term the body does not precess.
void Body::add_gyroscopic_torque(double step_s) {
  const Matrix3d R_WB = rotation_to_eigen(R_WB_);
  const Vector3d w = R_WB.transpose() * to_eigen(w_WB_W_);
  const auto next = angular_velocity_after(inertia_C_B_, w, Vector3d::Zero(), step_s);
  // Such a rotation cannot be resolved by the step.
  if (!next) return;
  const Vector3d torque_W = R_WB * (inertia_C_B_ * (*next - w) / step_s);
  if (!torque_W.isZero(0)) store(torque_Nm_, to_eigen(torque_Nm_) + torque_W);
}

/// Writes an attitude as dBodySetQuaternion() does, without marking the parts as moved.
void Body::write_rotation(const Quaterniond& q_WB) {
  const double scale =
      1 / std::sqrt(q_WB.w() * q_WB.w() + q_WB.x() * q_WB.x() + q_WB.y() * q_WB.y() + q_WB.z() * q_WB.z());
  const double w = q_WB.w() * scale, x = q_WB.x() * scale, y = q_WB.y() * scale, z = q_WB.z() * scale;
  const double q[] = {w, x, y, z};
  std::copy_n(q, 4, q_WB_);
  const double xx = 2 * x * x, yy = 2 * y * y, zz = 2 * z * z;
  const double R[] = {1 - yy - zz,         2 * (x * y - w * z), 2 * (x * z + w * y), 0,  //
                      2 * (x * y + w * z), 1 - xx - zz,         2 * (y * z - w * x), 0,  //
                      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - xx - yy,         0};
  std::copy_n(R, 12, R_WB_);
}

[[gnu::flatten]] void Body::step_alone(double step_s, double gravity_mps2) {
  const double h = step_s;
  const Matrix3d R_WB = rotation_to_eigen(R_WB_);
  Vector3d v_before_W = to_eigen(v_WC_W_), w_before_B = R_WB.transpose() * to_eigen(w_WB_W_);
  Vector3d force_W = applied_force_W(), torque_W = applied_torque_W();
  if (gravity_) force_W.z() -= mass_kg_ * gravity_mps2;
  const Quaterniond q_WB(q_WB_[0], q_WB_[1], q_WB_[2], q_WB_[3]);
  // Velocities at the end.
  Vector3d v_W = v_before_W, w_B;
  if (planned_) {
    // Forces that were added to the plan act on the rigid body.
    if (plan_applied_) {
      force_W -= planned_force_W_;
      torque_W -= planned_torque_W_;
    }
    w_B = w_B_at_end_;
    if (!torque_W.isZero(0)) w_B += h * inertia_C_B_.llt().solve(R_WB.transpose() * torque_W);
  } else {
    const Vector3d torque_B = (q_WB * cayley(w_before_B, h / 2)).conjugate() * torque_W;
    const auto next = gyroscopic_ ? angular_velocity_after(inertia_C_B_, w_before_B, torque_B, h) : std::nullopt;
    w_B = next ? *next : w_before_B + h * inertia_C_B_.llt().solve(torque_B);  // or too fast for the step
  }
  // Of a body that ODE stepped, the velocities are those half a step before its pose, see leave_to_ode().
  const bool after_ode = last_step_ == LastStep::ode;
  if (after_ode) {
    const Vector3d half_B = (w_B - w_before_B) / 2;
    w_before_B += half_B;
    w_B += half_B;
  }
  const Eigen::Quaterniond q_after = q_WB * cayley((w_before_B + w_B) / 2, h);
  if (planned_) v_W = q_after * v_C_B_at_end_ + carried_W_;
  v_W += h / mass_kg_ * force_W;
  if (after_ode) {
    const Vector3d half_W = (v_W - v_before_W) / 2;
    v_before_W += half_W;
    v_W += half_W;
  }
  const Vector3d p_WC = to_eigen(p_WC_) + h / 2 * (v_before_W + v_W);
  // Write the motion into ODE.
  store(p_WC_, p_WC);
  write_rotation(q_after);
  store(v_WC_W_, v_W);
  store(w_WB_W_, rotation_to_eigen(R_WB_) * w_B);
  store(force_N_, Vector3d::Zero());
  store(torque_Nm_, Vector3d::Zero());
  planned_ = plan_applied_ = false;
  a_WC_W_ = (v_W - v_before_W) / h;
  alpha_B_ = (w_B - w_before_B) / h;
  last_step_ = LastStep::alone;
}

/// The step of ODE moves a body by the velocity at its end.  With a constant acceleration that is exact when the
/// velocity is the one half a step before the pose, as in the leapfrog method; what ODE begins with and what it leaves
/// are taken for such velocities.  Otherwise a body that bounces would gain about g h v with each contact.
void Body::leave_to_ode(double step_s) {
  if (planned_ && !plan_applied_) apply_plan();
  planned_ = plan_applied_ = false;
  if (last_step_ == LastStep::alone) {
    const Vector3d w_B = rotation_to_eigen(R_WB_).transpose() * to_eigen(w_WB_W_) - step_s / 2 * alpha_B_;
    const Vector3d v_W = to_eigen(v_WC_W_) - step_s / 2 * a_WC_W_, w_W = rotation_to_eigen(R_WB_) * w_B;
    store(v_WC_W_, v_W);
    store(w_WB_W_, w_W);
  }
  a_WC_W_.setZero();
  alpha_B_.setZero();
  last_step_ = LastStep::ode;
}

[[gnu::flatten]] BodyMotion Body::motion_for_forces(double step_s) const {
  // A body whose velocities were set is expected to be alone.
  if (!free() || last_step_ == LastStep::ode) return motion();
  const double half_s = step_s / 2;
  const Matrix3d R_WB_now = rotation_to_eigen(R_WB_);
  const Vector3d w_B = R_WB_now.transpose() * to_eigen(w_WB_W_);
  const Quaterniond q_WB(q_WB_[0], q_WB_[1], q_WB_[2], q_WB_[3]);
  BodyMotion middle{(q_WB * cayley(w_B, half_s)).toRotationMatrix()};
  middle.w_WB_W = middle.R_WB * (w_B + half_s * alpha_B_);
  const Vector3d p_BC_W = middle.R_WB * p_BC_;
  middle.p_WB = to_eigen(p_WC_) + half_s * to_eigen(v_WC_W_) - p_BC_W;
  middle.v_WB_W = to_eigen(v_WC_W_) + half_s * a_WC_W_ - middle.w_WB_W.cross(p_BC_W);
  return middle;
}

void Body::add_force_at_W(const Vector3d& force_N, const Vector3d& p_CP_W) {
  if (!force_N.allFinite() || !p_CP_W.allFinite())
    throw PhysicsFault("body '" + name_ + "': a force on it is not finite");
  if (!free()) return;
  const Vector3d torque_Nm = p_CP_W.cross(force_N);
  store(force_N_, to_eigen(force_N_) + force_N);
  store(torque_Nm_, to_eigen(torque_Nm_) + torque_Nm);
}

void Body::set_velocity_at_end(const Vector3d& v_C_B, const Vector3d& carried_W, const Vector3d& w_B, double step_s) {
  if (!v_C_B.allFinite() || !carried_W.allFinite() || !w_B.allFinite())
    throw PhysicsFault("body '" + name_ + "': the forces of the water on it are not finite");
  planned_ = true;
  plan_applied_ = false;
  plan_step_s_ = step_s;
  v_C_B_at_end_ = v_C_B;
  carried_W_ = carried_W;
  w_B_at_end_ = w_B;
  set_applied_W(Vector3d::Zero(), Vector3d::Zero());
}

/// Adds the forces that give the body the planned velocities, which a step of ODE needs, and contacts.
void Body::apply_plan() {
  plan_applied_ = true;
  const Matrix3d R_WB = rotation_to_eigen(R_WB_);
  const Vector3d w_before_B = R_WB.transpose() * to_eigen(w_WB_W_);
  const Matrix3d R_after = R_WB * cayley((w_before_B + w_B_at_end_) / 2, plan_step_s_).toRotationMatrix();
  planned_force_W_ = mass_kg_ / plan_step_s_ * (R_after * v_C_B_at_end_ + carried_W_ - to_eigen(v_WC_W_));
  planned_torque_W_ = R_WB * (inertia_C_B_ * (R_WB.transpose() * (R_after * w_B_at_end_) - w_before_B)) / plan_step_s_;
  store(force_N_, planned_force_W_ + to_eigen(force_N_));
  store(torque_Nm_, planned_torque_W_ + to_eigen(torque_Nm_));
}

}  // namespace sim
