// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/joint.hpp"

#include <algorithm>
#include <numbers>
#include <span>
#include <utility>

#include "sim/ode/ode_math.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/physics/joint_load.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {
namespace {

int axes_of(JointType type, bool ball_motor) {
  switch (type) {
    case JointType::ball:
      return ball_motor ? 3 : 0;
    case JointType::hinge:
    case JointType::slider:
      return 1;
    case JointType::hinge2:
    case JointType::universal:
      return 2;
    case JointType::fixed:
      break;
  }
  return 0;
}

/// Configuration of an axis; all axes of a ball share one.
const JointAxisConfig& axis_config(const JointConfig& config, int axis) {
  return axis == 0 || config.type == JointType::ball ? config.axis1 : config.axis2;
}

/// Sets the angles of a ball's motor.  ODE does not measure the angles of a motor in user mode, and needs them for the
/// stops.
void set_ball_angles(dJointID motor, double sign, std::span<const double> position) {
  for (int axis = 0; motor != nullptr && axis < dJointGetAMotorNumAxes(motor); ++axis)
    dJointSetAMotorAngle(motor, axis, sign * position[static_cast<std::size_t>(axis)]);
}

template <class OdePose>
OdePose copy_pose(dBodyID body) {
  OdePose pose;
  std::copy_n(dBodyGetPosition(body), 3, pose.p);
  std::copy_n(dBodyGetQuaternion(body), 4, pose.q);
  std::copy_n(dBodyGetRotation(body), 12, pose.R);
  return pose;
}

/// Writes the numbers into ODE's memory, because its setters would round them.
template <class OdePose>
void write_pose(dBodyID body, const OdePose& pose) {
  std::copy_n(pose.q, 4, const_cast<dReal*>(dBodyGetQuaternion(body)));
  std::copy_n(pose.R, 12, const_cast<dReal*>(dBodyGetRotation(body)));
  dBodySetPosition(body, pose.p[0], pose.p[1], pose.p[2]);  // marks the geoms as moved
}

}  // namespace

void JointDeleter::operator()(dxJoint* joint) const {
  dJointDestroy(joint);
}

Joint::~Joint() = default;

Joint::Joint(dWorldID world, std::string name, const JointConfig& config, dBodyID first, dBodyID second,
             const Pose& X_WV)
    : name_(std::move(name)), type_(config.type), axes_(axes_of(config.type, config.motor)) {
  // ODE gets the moving body first: with the world first it would invert some of the signs.
  sign_ = first != nullptr && second != nullptr ? -1 : 1;
  if (first == nullptr) std::swap(first, second);
  loaded_ = second != nullptr ? second : first;
  const Pose X_WC = ode_pose(loaded_);
  origin_ = std::make_unique<Origin>(
      Origin{config, X_WV, second == nullptr, X_WC, copy_pose<OdePose>(first), copy_pose<OdePose>(loaded_)});
  origin_->config.name.clear();  // not used
  origin_->config.bodies.clear();
  create(world, first, second);
  p_CA_C_ = X_WC.inverse() * (X_WV * config.anchor_m);
  // Apply the configuration, and note the initial angles and stops.
  for (int axis = 0; axis < axes_; ++axis) configure_axis(axis_config(config, axis), axis);
  for (int axis = 0; axis < axes_; ++axis) {
    wrapped_[axis] = wrapped_position(axis);
    configured_stops_[axis] = stops_[axis];
  }
}

void Joint::create(dWorldID world, dBodyID first, dBodyID second) {
  // Anchor and axes in the world.
  const JointConfig& config = origin_->config;
  const Pose& X_WV = origin_->X_WV;
  const Vector3d anchor = X_WV * config.anchor_m;
  const Vector3d axis1 = (X_WV.linear() * config.axis1.axis).normalized();
  const Vector3d axis2 = (X_WV.linear() * config.axis2.axis).normalized();
  const auto attach = [&](dJointID joint) {
    ode_.reset(joint);
    dJointAttach(joint, first, second);
    return joint;
  };
  switch (type_) {
    case JointType::fixed: {
      const dJointID joint = attach(dJointCreateFixed(world, nullptr));
      dJointSetFixed(joint);
      if (config.axis1.erp) dJointSetFixedParam(joint, dParamERP, *config.axis1.erp);
      return;
    }
    case JointType::ball: {
      const dJointID joint = attach(dJointCreateBall(world, nullptr));
      dJointSetBallAnchor(joint, anchor.x(), anchor.y(), anchor.z());
      if (config.axis1.erp) dJointSetBallParam(joint, dParamERP, *config.axis1.erp);
      if (config.motor) create_ball_motor(world, first, second);
      return;
    }
    case JointType::hinge: {
      const dJointID joint = attach(dJointCreateHinge(world, nullptr));
      dJointSetHingeAnchor(joint, anchor.x(), anchor.y(), anchor.z());
      dJointSetHingeAxis(joint, axis1.x(), axis1.y(), axis1.z());
      return;
    }
    case JointType::hinge2: {
      const dJointID joint = attach(dJointCreateHinge2(world, nullptr));
      const dVector3 a1 = {axis1.x(), axis1.y(), axis1.z(), 0}, a2 = {axis2.x(), axis2.y(), axis2.z(), 0};
      dJointSetHinge2Anchor(joint, anchor.x(), anchor.y(), anchor.z());
      dJointSetHinge2Axes(joint, a1, a2);
      return;
    }
    case JointType::universal: {
      const dJointID joint = attach(dJointCreateUniversal(world, nullptr));
      dJointSetUniversalAnchor(joint, anchor.x(), anchor.y(), anchor.z());
      dJointSetUniversalAxis1(joint, axis1.x(), axis1.y(), axis1.z());
      dJointSetUniversalAxis2(joint, axis2.x(), axis2.y(), axis2.z());
      return;
    }
    case JointType::slider:
      dJointSetSliderAxis(attach(dJointCreateSlider(world, nullptr)), axis1.x(), axis1.y(), axis1.z());
  }
}

/// Creates an angular motor with axes fixed to the first body.  ODE cannot measure its angles, so that they are set in
/// each step.
void Joint::create_ball_motor(dWorldID world, dBodyID first, dBodyID second) {
  const Pose& X_WV = origin_->X_WV;
  const dJointID motor = dJointCreateAMotor(world, nullptr);
  ball_motor_.reset(motor);
  dJointAttach(motor, first, second);
  dJointSetAMotorMode(motor, dAMotorUser);
  dJointSetAMotorNumAxes(motor, max_axes);
  const int of_first_body = second != nullptr ? 1 : 0;
  for (int axis = 0; axis < max_axes; ++axis) {
    const Vector3d along = X_WV.linear().col(axis);
    dJointSetAMotorAxis(motor, axis, of_first_body, along.x(), along.y(), along.z());
  }
  const Matrix3d R_WF = second != nullptr ? Matrix3d(ode_pose(first).linear()) : Matrix3d(Matrix3d::Identity());
  R_F_axes_ = R_WF.transpose() * X_WV.linear();
  R_FS_ = R_WF.transpose() * ode_pose(second != nullptr ? second : first).linear();
}

/// Rotation of the second body relative to the first since the joint was created: rotation vector along the ball's
/// axes.
Vector3d Joint::rotation_of_ball() const {
  const dBodyID first = dJointGetBody(ode_.get(), 0), second = dJointGetBody(ode_.get(), 1);
  const Matrix3d R_WF = second != nullptr ? Matrix3d(ode_pose(first).linear()) : Matrix3d(Matrix3d::Identity());
  const Matrix3d R_WS = ode_pose(second != nullptr ? second : first).linear();
  const Eigen::AngleAxisd turned(Matrix3d(R_WF.transpose() * R_WS * R_FS_.transpose()));
  return R_F_axes_.transpose() * (turned.angle() * turned.axis());
}

void Joint::configure_axis(const JointAxisConfig& config, int axis) {
  const auto set = [&](int parameter, const std::optional<double>& value) {
    if (value) set_parameter(parameter, *value, axis);
  };
  damping_[axis] = config.damping;
  place_stops(config.low_stop, config.high_stop, axis);
  set(dParamBounce, config.restitution);
  set(dParamCFM, config.cfm);
  set(dParamStopERP, config.stop_erp);
  set(dParamStopCFM, config.stop_cfm);
  set(dParamFudgeFactor, config.fudge_factor);
  set(dParamSuspensionERP, config.suspension_erp);
  set(dParamSuspensionCFM, config.suspension_cfm);
  if (config.motor_max_force > 0) set_motor(config.motor_velocity, config.motor_max_force, axis);
}

void Joint::place_stops(std::optional<double> low, std::optional<double> high, int axis) {
  // With the opposite sign the low stop is the high one.
  if (sign_ < 0) std::swap(low, high);
  put_stops({low ? sign_ * *low : -dInfinity, high ? sign_ * *high : dInfinity}, axis);
}

void Joint::put_stops(const OdeStops& stops, int axis) {
  const bool none = stops.low > stops.high || (type_ == JointType::hinge2 && axis == 1);
  stops_[axis] = none ? OdeStops{} : stops;
  give_stops_to_ode(axis);
}

void Joint::give_stops_to_ode(int axis) {
  OdeStops stops = stops_[axis];
  if (type_ != JointType::slider && type_ != JointType::ball) {
    const double turn = 2 * std::numbers::pi;
    const double turns = sign_ * turn * std::round((position_[axis] - wrapped_[axis]) / turn);
    stops.low -= turns;
    stops.high -= turns;
  }
  give_ode_stops(stops, axis);
}

void Joint::give_ode_stops(OdeStops stops, int axis) {
  // ODE tests the angle of a hinge only if there is a stop from -pi to pi, and otherwise leaves it at the stop at which
  // it was.  This angle is below pi.
  const OdeStops before{get_parameter(dParamLoStop, axis), get_parameter(dParamHiStop, axis)};
  if (type_ == JointType::hinge && (before.any() || stops.any()) && stops.low < -std::numbers::pi &&
      stops.high > std::numbers::pi)
    stops = {-dInfinity, std::numbers::pi};
  set_parameter(dParamLoStop, stops.low, axis);
  set_parameter(dParamHiStop, stops.high, axis);
  // ODE moves one stop when the other one would be beyond it.
  set_parameter(dParamLoStop, stops.low, axis);
}

void Joint::set_stops(std::optional<double> low, std::optional<double> high, int axis) {
  if (std::isnan(low.value_or(0)) || std::isnan(high.value_or(0)))
    throw PhysicsFault("joint '" + name_ + "': its stop is not a number");
  place_stops(low, high, axis);
  stops_were_set_ = true;
}

void Joint::set_parameter(int parameter, double value, int axis) {
  parameter += dParamGroup * axis;
  switch (type_) {
    case JointType::hinge:
      return dJointSetHingeParam(ode_.get(), parameter, value);
    case JointType::slider:
      return dJointSetSliderParam(ode_.get(), parameter, value);
    case JointType::hinge2:
      return dJointSetHinge2Param(ode_.get(), parameter, value);
    case JointType::universal:
      return dJointSetUniversalParam(ode_.get(), parameter, value);
    case JointType::ball:
      if (ball_motor_) dJointSetAMotorParam(ball_motor_.get(), parameter, value);
      return;
    case JointType::fixed:
      return;
  }
}

int Joint::max_rows() const {
  switch (type_) {
    case JointType::ball:
      return ball_motor_ ? 6 : 3;
    case JointType::fixed:
    case JointType::hinge:
    case JointType::hinge2:
    case JointType::universal:
    case JointType::slider:
      break;
  }
  return 6;
}

double Joint::velocity(int axis) const {
  switch (type_) {
    case JointType::hinge:
      return sign_ * dJointGetHingeAngleRate(ode_.get());
    case JointType::slider:
      return sign_ * dJointGetSliderPositionRate(ode_.get());
    case JointType::hinge2:
      return sign_ * (axis == 0 ? dJointGetHinge2Angle1Rate(ode_.get()) : dJointGetHinge2Angle2Rate(ode_.get()));
    case JointType::universal:
      return sign_ * (axis == 0 ? dJointGetUniversalAngle1Rate(ode_.get()) : dJointGetUniversalAngle2Rate(ode_.get()));
    case JointType::ball: {
      if (!ball_motor_) return 0;
      const dBodyID first = dJointGetBody(ode_.get(), 0), second = dJointGetBody(ode_.get(), 1);
      Vector3d w_W = to_eigen(dBodyGetAngularVel(first));
      if (second != nullptr) w_W -= to_eigen(dBodyGetAngularVel(second));
      return sign_ * w_W.dot(axis_W(axis));
    }
    case JointType::fixed:
      break;
  }
  return 0;
}

double Joint::wrapped_position(int axis) const {
  switch (type_) {
    case JointType::hinge:
      return sign_ * dJointGetHingeAngle(ode_.get());
    case JointType::slider:
      return sign_ * dJointGetSliderPosition(ode_.get());
    case JointType::hinge2:
      return axis == 0 ? sign_ * dJointGetHinge2Angle1(ode_.get()) : 0;
    case JointType::universal:
      return sign_ * (axis == 0 ? dJointGetUniversalAngle1(ode_.get()) : dJointGetUniversalAngle2(ode_.get()));
    case JointType::ball:
      return position_[axis];
    case JointType::fixed:
      break;
  }
  return 0;
}

void Joint::update_position(double step_s) {
  if (type_ == JointType::slider) {
    position_[0] = wrapped_position(0);
    return;
  }
  if (type_ == JointType::ball) {
    Vector3d rotation = rotation_of_ball();
    const Eigen::Map<const Vector3d> before(position_);
    if (const double angle = rotation.norm(); angle > 0) {
      const Vector3d other = (1 - 2 * std::numbers::pi / angle) * rotation;
      if ((other - before).squaredNorm() < (rotation - before).squaredNorm()) rotation = other;
    }
    for (int axis = 0; axis < axes_; ++axis) position_[axis] = rotation[axis];
    set_ball_angles(ball_motor_.get(), sign_, position_);
    return;
  }
  for (int axis = 0; axis < axes_; ++axis) {
    // Free wheels are integrated; other angles are measured.
    const double expected = velocity(axis) * step_s;
    if (type_ == JointType::hinge2 && axis == 1) {
      position_[1] += expected;
      continue;
    }
    const double wrapped = wrapped_position(axis);
    double moved = wrapped - wrapped_[axis];
    // ODE's angle wraps at pi.  The rate gives the number of turns in the step; the angle gives the exact remainder.
    const bool wraps = std::abs(moved - expected) > std::numbers::pi;
    if (wraps) moved += 2 * std::numbers::pi * std::round((expected - moved) / (2 * std::numbers::pi));
    wrapped_[axis] = wrapped;
    position_[axis] += moved;
    if (wraps && stops_[axis].any()) give_stops_to_ode(axis);
  }
}

void Joint::set_motor(double velocity, double max_force, int axis) {
  if (!std::isfinite(velocity) || !(max_force >= 0) || !std::isfinite(max_force))
    throw PhysicsFault("joint '" + name_ + "': its motor's velocity or force is not a finite number");
  if (velocity == motor_velocity_[axis] && max_force == motor_max_force_[axis]) return;
  motor_velocity_[axis] = velocity;
  motor_max_force_[axis] = max_force;
  set_parameter(dParamVel, sign_ * velocity, axis);
  set_parameter(dParamFMax, max_force, axis);
}

double Joint::get_parameter(int parameter, int axis) const {
  parameter += dParamGroup * axis;
  switch (type_) {
    case JointType::hinge:
      return dJointGetHingeParam(ode_.get(), parameter);
    case JointType::slider:
      return dJointGetSliderParam(ode_.get(), parameter);
    case JointType::hinge2:
      return dJointGetHinge2Param(ode_.get(), parameter);
    case JointType::universal:
      return dJointGetUniversalParam(ode_.get(), parameter);
    case JointType::ball:
      return ball_motor_ ? dJointGetAMotorParam(ball_motor_.get(), parameter) : 0;
    case JointType::fixed:
      break;
  }
  return 0;
}

Vector3d Joint::axis_W(int axis) const {
  dVector3 out = {0, 0, 0, 0};
  if (type_ == JointType::hinge)
    dJointGetHingeAxis(ode_.get(), out);
  else if (type_ == JointType::slider)
    dJointGetSliderAxis(ode_.get(), out);
  else if (type_ == JointType::hinge2)
    axis == 0 ? dJointGetHinge2Axis1(ode_.get(), out) : dJointGetHinge2Axis2(ode_.get(), out);
  else if (type_ == JointType::universal)
    axis == 0 ? dJointGetUniversalAxis1(ode_.get(), out) : dJointGetUniversalAxis2(ode_.get(), out);
  else if (ball_motor_)
    dJointGetAMotorAxis(ball_motor_.get(), axis, out);
  return to_eigen(out);
}

/// Moves the world side of a joint.  ODE stores it in the world frame and measures from the pose at which the joint was
/// created, so that the joint is created again, with its body temporarily at that pose.
void Joint::move_world_side(const Pose& X_move_W) {
  if (origin_->to_world) make_again(X_move_W * origin_->X_WV, X_move_W * origin_->X_WC);
}

void Joint::make_again(const Pose& X_WV, const Pose& X_WC) {
  origin_->X_WV = X_WV;
  origin_->X_WC = X_WC;
  // The pose as ODE rounds it.
  const OdePose now = copy_pose<OdePose>(loaded_);
  dQuaternion q_made;
  to_ode(to_quaternion(X_WC.linear()), q_made);
  dBodySetPosition(loaded_, X_WC.translation().x(), X_WC.translation().y(), X_WC.translation().z());
  dBodySetQuaternion(loaded_, q_made);
  origin_->first = copy_pose<OdePose>(loaded_);
  write_pose(loaded_, now);
  create_again(dBodyGetWorld(loaded_), loaded_, nullptr);
}

void Joint::create_again(dWorldID world, dBodyID first, dBodyID second) {
  // Save stops and motor set-points.
  OdeStops stops[max_axes];
  std::copy_n(stops_, max_axes, stops);
  // Create the joint with the bodies at its creation poses, and move them back.
  const OdePose first_now = copy_pose<OdePose>(first);
  const OdePose second_now = second != nullptr ? copy_pose<OdePose>(second) : first_now;
  write_pose(first, origin_->first);
  if (second != nullptr) write_pose(second, origin_->second);
  create(world, first, second);
  write_pose(first, first_now);
  if (second != nullptr) write_pose(second, second_now);
  loaded_ = second != nullptr ? second : first;
  // Restore stops and motor set-points.
  for (int axis = 0; axis < axes_; ++axis) {
    const double velocity = motor_velocity_[axis], max_force = motor_max_force_[axis];
    configure_axis(axis_config(origin_->config, axis), axis);
    put_stops(stops[axis], axis);
    set_motor(velocity, max_force, axis);
    // The new ODE joint needs these values even when set_motor finds no change.
    set_parameter(dParamVel, sign_ * velocity, axis);
    set_parameter(dParamFMax, max_force, axis);
  }
  set_ball_angles(ball_motor_.get(), sign_, position_);
  if (load_) request_load();
}

void Joint::visit_state(StateArchive& archive) {
  archive.unhashed(stops_were_set_);
  for (int axis = 0; axis < axes_; ++axis) {
    visit_stops(archive, axis);
    archive(position_[axis], wrapped_[axis], motor_velocity_[axis], motor_max_force_[axis]);
    if (!archive.restoring()) continue;
    for (const double number : {position_[axis], wrapped_[axis], motor_velocity_[axis], motor_max_force_[axis]})
      if (!std::isfinite(number)) archive.fail("joint '" + name_ + "' has a number that is not finite");
    set_parameter(dParamVel, sign_ * motor_velocity_[axis], axis);
    set_parameter(dParamFMax, motor_max_force_[axis], axis);
    give_stops_to_ode(axis);  // by the position
  }
  if (archive.restoring()) {
    set_ball_angles(ball_motor_.get(), sign_, position_);
    leaves_stops_ = false;  // after a step that failed
  }
  visit_load(archive);
}

/// Visits the stops: state when they were set at run time, else those of the configuration.
void Joint::visit_stops(StateArchive& archive, int axis) {
  OdeStops stops = stops_[axis];
  if (stops_were_set_) {
    archive.not_only_finite(stops.low, stops.high);
    if (std::isnan(stops.low) || std::isnan(stops.high))
      archive.fail("joint '" + name_ + "' has a stop that is not a number");
  } else if (archive.restoring()) {
    stops = configured_stops_[axis];
  }
  if (archive.restoring()) put_stops(stops, axis);
}

}  // namespace sim
