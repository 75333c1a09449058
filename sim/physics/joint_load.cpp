// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/joint_load.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/ode/ode_math.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/state/state_archive.hpp"

// Efforts on a joint, and its load.

namespace sim {

namespace {

constexpr double solver_rounding = 1e-9;  // rad/s or m/s: above that of a velocity
constexpr double stop_rounding = 1e-9;    // rad or m: above that of a position, which sums the angles that ODE measures
constexpr double no_force_cfm = 1e12;     // (m/s)/N: a row this soft gives no force
constexpr double no_force_limit = 1e12;   // N, or N m
constexpr double min_damping = 1e-12;     // N s/m, or N m s/rad: its row stays finite

}  // namespace

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

bool Joint::leaves_stop(int axis) const {
  const OdeStops& stops = stops_[axis];
  const double velocity = sign_ * motor_velocity_[axis], position = sign_ * position_[axis];
  if (!(motor_max_force_[axis] > 0) || stops.low >= stops.high) return false;
  return (velocity > 0 && position <= stops.low + stop_rounding) ||
         (velocity < 0 && position >= stops.high - stop_rounding);
}

double Joint::depth_in_stop(int axis) const {
  const OdeStops& stops = stops_[axis];
  const double position = sign_ * position_[axis];
  return std::max(sign_ * motor_velocity_[axis] > 0 ? stops.low - position : position - stops.high, 0.0);
}

// ODE has one row of constraints for the motor and the stops of an axis.  At a stop this row is the stop's, and ODE
// applies the motor as an external force, at its maximum (dxJointLimitMotor::addLimot).  That is right for a motor that
// pushes into the stop or holds.  One that drives away would be accelerated without regard to its velocity: it keeps
// the row, and the stop gets one of another joint for this step.  ODE's exact solver treats the row of that joint last.
// Two equal rows are nearly singular, but not when the motor comes first and meets the stop too, or is at its limit: it
// runs at least at the velocity with which the stop pushes the joint back.
bool Joint::start_leaving_stops(dJointGroupID group, double step_s) {
  int leaving[max_axes], count = 0;
  for (int axis = 0; axis < axes_; ++axis)
    if (leaves_stop(axis)) leaving[count++] = axis;
  if (count == 0) return false;
  leaves_stops_ = true;
  const dJointID stop =
      type_ == JointType::slider ? create_slider_stop(group) : dJointCreateAMotor(dBodyGetWorld(loaded_), group);
  dJointAttach(stop, dJointGetBody(ode_.get(), 0), dJointGetBody(ode_.get(), 1));
  if (type_ != JointType::slider) dJointSetAMotorNumAxes(stop, count);
  for (int i = 0; i < count; ++i) {
    const int axis = leaving[i];
    if (type_ != JointType::slider) {
      const Vector3d along = axis_W(axis);
      dJointSetAMotorAxis(stop, i, 0, along.x(), along.y(), along.z());
      dJointSetAMotorAngle(stop, i, sign_ * position_[axis]);
      const auto set = [&](int parameter, double value) {
        dJointSetAMotorParam(stop, parameter + dParamGroup * i, value);
      };
      set(dParamLoStop, stops_[axis].low);
      set(dParamHiStop, stops_[axis].high);
      for (const int parameter : {dParamStopERP, dParamStopCFM, dParamBounce})
        set(parameter, get_parameter(parameter, axis));
    }
    const double back = get_parameter(dParamStopERP, axis) * depth_in_stop(axis) / step_s + solver_rounding;
    const double velocity = sign_ * motor_velocity_[axis];
    set_parameter(dParamVel, std::copysign(std::max(std::abs(velocity), back), velocity), axis);
    set_parameter(dParamFMax, get_parameter(dParamFudgeFactor, axis) * motor_max_force_[axis], axis);
    give_ode_stops({}, axis);
  }
  if (load_) dJointSetFeedback(stop, &load_->leaving_feedback);
  return true;
}

/// Makes a contact without friction whose row is that of the stop that the slider leaves: ODE's linear motor has none.
dJointID Joint::create_slider_stop(dJointGroupID group) const {
  const bool at_low = sign_ * motor_velocity_[0] > 0;
  dContact contact = {};
  contact.surface.mode = dContactSoftERP | dContactSoftCFM | dContactBounce;
  contact.surface.soft_erp = get_parameter(dParamStopERP, 0);
  contact.surface.soft_cfm = get_parameter(dParamStopCFM, 0);
  contact.surface.bounce = get_parameter(dParamBounce, 0);
  contact.geom.depth =
      depth_in_stop(0) + dWorldGetContactSurfaceLayer(dBodyGetWorld(loaded_));  // in which a contact has no depth
  const Vector3d normal_W = (at_low ? 1 : -1) * axis_W(0);
  const Vector3d p_W = middle_of_bodies_W();
  std::copy_n(normal_W.data(), 3, contact.geom.normal);
  std::copy_n(p_W.data(), 3, contact.geom.pos);
  return dJointCreateContact(dBodyGetWorld(loaded_), group, &contact);
}

Vector3d Joint::middle_of_bodies_W() const {
  const dBodyID first = dJointGetBody(ode_.get(), 0), second = dJointGetBody(ode_.get(), 1);
  const Vector3d p_W = to_eigen(dBodyGetPosition(first));
  return second == nullptr ? p_W : Vector3d((p_W + to_eigen(dBodyGetPosition(second))) / 2);
}

// A motor for the velocity 0 whose row is soft: its torque is -velocity / cfm at the end of the step (ODE User Guide,
// "Soft constraint and constraint force mixing"), so that damping is stable at any step and with any other joint.
void Joint::start_damping(dJointGroupID group) {
  int damped[max_axes], count = 0;
  for (int axis = 0; axis < axes_; ++axis)
    if (damping_[axis] > min_damping) damped[count++] = axis;
  damps_ = count > 0;
  if (!damps_) return;
  const bool slides = type_ == JointType::slider;
  const dJointID damper = slides ? create_slider_damper(group) : dJointCreateAMotor(dBodyGetWorld(loaded_), group);
  dJointAttach(damper, dJointGetBody(ode_.get(), 0), dJointGetBody(ode_.get(), 1));
  if (!slides) dJointSetAMotorNumAxes(damper, count);
  for (int i = 0; i < count && !slides; ++i) {
    const Vector3d along = axis_W(damped[i]);
    dJointSetAMotorAxis(damper, i, 0, along.x(), along.y(), along.z());
    dJointSetAMotorParam(damper, dParamFMax + dParamGroup * i, no_force_limit);
    dJointSetAMotorParam(damper, dParamCFM + dParamGroup * i, 1 / damping_[damped[i]]);
  }
  if (load_) dJointSetFeedback(damper, &load_->damping_feedback);
}

/// Makes a contact whose friction is that of the damper: ODE's linear motor pushes the bodies at their centers, off the
/// line of the slider.
dJointID Joint::create_slider_damper(dJointGroupID group) const {
  dContact contact = {};
  contact.surface.mode = dContactSoftCFM | dContactFDir1 | dContactSlip1 | dContactMu2;
  contact.surface.soft_cfm = no_force_cfm;
  contact.surface.mu = no_force_limit;
  contact.surface.slip1 = 1 / damping_[0];
  const Vector3d along_W = axis_W(0), normal_W = along_W.unitOrthogonal(), p_W = middle_of_bodies_W();
  std::copy_n(along_W.data(), 3, contact.fdir1);
  std::copy_n(normal_W.data(), 3, contact.geom.normal);
  std::copy_n(p_W.data(), 3, contact.geom.pos);
  return dJointCreateContact(dBodyGetWorld(loaded_), group, &contact);
}

void Joint::end_leaving_stops() {
  for (int axis = 0; axis < axes_; ++axis) {
    set_parameter(dParamVel, sign_ * motor_velocity_[axis], axis);
    set_parameter(dParamFMax, motor_max_force_[axis], axis);
    give_stops_to_ode(axis);
  }
  leaves_stops_ = false;
}

/// Motor effort that is missing in the feedback: at a stop ODE applies it as an external force.
double Joint::motor_at_stop(int axis) const {
  const double max_force = get_parameter(dParamFMax, axis);
  const double low = get_parameter(dParamLoStop, axis), high = get_parameter(dParamHiStop, axis);
  if (!(max_force > 0) || !stops_[axis].any() || low >= high) return 0;
  const double position = sign_ * wrapped_position(axis), velocity = get_parameter(dParamVel, axis);
  const bool at_low = position <= low, at_high = !at_low && position >= high;
  if (!at_low && !at_high) return 0;
  return velocity > 0 || (velocity == 0 && at_high) ? sign_ * max_force : -sign_ * max_force;
}

void Joint::note_load() {
  note_load_without_damping();  // also the efforts of the axes
  if (!damps_) return;
  const bool first = origin_->to_world;
  const dJointFeedback& damping = load_->damping_feedback;
  const Vector3d force_W_N = to_eigen(first ? damping.f1 : damping.f2);
  load_->force_W_N += force_W_N;
  load_->torque_W_Nm += to_eigen(first ? damping.t1 : damping.t2) - load_->p_CA_W.cross(force_W_N);
}

void Joint::note_load_without_damping() {
  Load& load = *load_;
  const bool first = origin_->to_world;
  // Constraint force and torque, moved to the anchor.
  load.force_W_N = to_eigen(first ? load.feedback.f1 : load.feedback.f2);
  load.torque_W_Nm = to_eigen(first ? load.feedback.t1 : load.feedback.t2) - load.p_CA_W.cross(load.force_W_N);
  if (ball_motor_) load.torque_W_Nm += to_eigen(first ? load.motor_feedback.t1 : load.motor_feedback.t2);
  if (leaves_stops_) {
    const Vector3d force_W_N = to_eigen(first ? load.leaving_feedback.f1 : load.leaving_feedback.f2);
    load.force_W_N += force_W_N;
    load.torque_W_Nm +=
        to_eigen(first ? load.leaving_feedback.t1 : load.leaving_feedback.t2) - load.p_CA_W.cross(force_W_N);
  }
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
