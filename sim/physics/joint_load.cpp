// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/joint_load.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "sim/ode/ode_math.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/state/state_archive.hpp"

// Efforts on a joint, and its load.

namespace sim {

void Joint::add_effort(double effort, int axis) {
  if (!std::isfinite(effort)) throw PhysicsFault("joint '" + name_ + "': an effort on it is not finite");
  if (load_) load_->added[axis] += effort;
  const double torque1 = axis == 0 ? sign_ * effort : 0, torque2 = axis == 1 ? sign_ * effort : 0;
  switch (type_) {
    case JointType::hinge:
      return dJointAddHingeTorque(ode_.get(), sign_ * effort);
    case JointType::slider:
      return dJointAddSliderForce(ode_.get(), sign_ * effort);
    case JointType::hinge2:
      return dJointAddHinge2Torques(ode_.get(), torque1, torque2);
    case JointType::universal:
      return dJointAddUniversalTorques(ode_.get(), torque1, torque2);
    case JointType::ball:
      if (ball_motor_) dJointAddAMotorTorques(ball_motor_.get(), torque1, torque2, axis == 2 ? sign_ * effort : 0);
      return;
    case JointType::fixed:
      return;
  }
}

void Joint::measure_load() {
  if (load_) return;
  load_ = std::make_unique<Load>();
  request_load();
}

void Joint::measure_no_load() {
  if (!load_) return;
  dJointSetFeedback(ode_.get(), nullptr);
  if (ball_motor_) dJointSetFeedback(ball_motor_.get(), nullptr);
  load_.reset();
}

void Joint::request_load() {
  dJointSetFeedback(ode_.get(), &load_->feedback);
  if (ball_motor_) dJointSetFeedback(ball_motor_.get(), &load_->motor_feedback);
}

void Joint::note_before_step() {
  const Pose X_WC = ode_pose(loaded_);
  load_->p_CA_W = X_WC.linear() * p_CA_C_;
  // ODE applies forces along a slider half way between the two bodies, so that neither of them is rotated.
  const dBodyID other = origin_->to_world ? loaded_ : dJointGetBody(ode_.get(), 0);
  load_->p_AM_W = (to_eigen(dBodyGetPosition(other)) - X_WC.translation()) / 2 - load_->p_CA_W;
  for (int axis = 0; axis < axes_; ++axis) {
    load_->axis_W[axis] = axis_W(axis);
    load_->beside[axis] = std::exchange(load_->added[axis], 0.0) + motor_at_stop(axis);
  }
}

/// Motor effort that is missing in the feedback.  At a stop, ODE uses the row of the motor for the stop and applies the
/// motor as an external force (dxJointLimitMotor::addLimot).
double Joint::motor_at_stop(int axis) const {
  const double max_force = get_parameter(dParamFMax, axis);
  const double low = get_parameter(dParamLoStop, axis), high = get_parameter(dParamHiStop, axis);
  const double bound = type_ == JointType::slider ? dInfinity : std::numbers::pi;
  const bool has_stops = type_ == JointType::slider ? low > -bound || high < bound : low >= -bound || high <= bound;
  if (!(max_force > 0) || !has_stops || low >= high || (type_ == JointType::hinge2 && axis == 1)) return 0;
  const double position = sign_ * wrapped_position(axis), velocity = get_parameter(dParamVel, axis);
  const bool at_low = position <= low, at_high = !at_low && position >= high;
  if (!at_low && !at_high) return 0;
  const bool upwards = velocity > 0 || (velocity == 0 && at_high);
  const bool away = (at_low && velocity > 0) || (at_high && velocity < 0);
  return sign_ * (upwards ? max_force : -max_force) * (away ? get_parameter(dParamFudgeFactor, axis) : 1);
}

void Joint::note_load() {
  Load& load = *load_;
  const bool first = origin_->to_world;
  // Constraint force and torque, moved to the anchor.
  load.force_W_N = to_eigen(first ? load.feedback.f1 : load.feedback.f2);
  load.torque_W_Nm = to_eigen(first ? load.feedback.t1 : load.feedback.t2) - load.p_CA_W.cross(load.force_W_N);
  if (ball_motor_) load.torque_W_Nm += to_eigen(first ? load.motor_feedback.t1 : load.motor_feedback.t2);
  for (int axis = 0; axis < axes_; ++axis) {
    // Add the efforts that are missing in ODE's feedback.
    const Vector3d beside_W = load.beside[axis] * load.axis_W[axis];
    if (type_ == JointType::slider) load.force_W_N += beside_W;
    load.torque_W_Nm += type_ == JointType::slider ? Vector3d(load.p_AM_W.cross(beside_W)) : beside_W;
  }
  // Project the load on the axes.
  const Vector3d& along = type_ == JointType::slider ? load.force_W_N : load.torque_W_Nm;
  if (type_ == JointType::ball) {
    for (int axis = 0; axis < axes_; ++axis) load.effort[axis] = along.dot(load.axis_W[axis]);
    return;
  }
  const Vector3d &a = load.axis_W[0], &b = load.axis_W[1];
  load.effort[0] = axes_ > 0 ? along.dot(a) : 0;
  if (axes_ < 2) return;
  // The constraint torque is perpendicular to both axes, which need not be perpendicular to each other.
  const double cosine = a.dot(b), scale = 1 / (1 - cosine * cosine);
  load.effort[0] = scale * (along.dot(a) - cosine * along.dot(b));
  load.effort[1] = scale * (along.dot(b) - cosine * along.dot(a));
}

Vector3d Joint::force_W_N() const {
  return load_ ? load_->force_W_N : Vector3d(Vector3d::Zero());
}

Vector3d Joint::torque_W_Nm() const {
  return load_ ? load_->torque_W_Nm : Vector3d(Vector3d::Zero());
}

double Joint::effort(int axis) const {
  return load_ ? load_->effort[axis] : 0;
}

void Joint::visit_load(StateArchive& archive) {
  bool measured = load_ != nullptr;
  archive.unhashed(measured);
  if (measured)
    measure_load();
  else
    measure_no_load();
  if (load_) archive.unhashed(load_->added, load_->force_W_N, load_->torque_W_Nm, load_->effort);
}

}  // namespace sim
