#include "sim/physics/joint.hpp"

#include <numbers>
#include <utility>

#include "sim/physics/ode_math.hpp"
#include "sim/physics/physics_world.hpp"

namespace sim {
namespace {

dJointType kind_of(const std::string& type) {
  static const std::pair<const char*, dJointType> kinds[] = {
      {"fixed", dJointTypeFixed},   {"ball", dJointTypeBall},           {"hinge", dJointTypeHinge},
      {"hinge2", dJointTypeHinge2}, {"universal", dJointTypeUniversal}, {"slider", dJointTypeSlider}};
  for (const auto& [name, kind] : kinds)
    if (type == name) return kind;
  throw std::invalid_argument("unknown type of joint '" + type + "'");
}

int axes_of(dJointType kind) {
  switch (kind) {
    case dJointTypeHinge:
    case dJointTypeSlider:
      return 1;
    case dJointTypeHinge2:
    case dJointTypeUniversal:
      return 2;
    default:
      return 0;
  }
}

}  // namespace

Joint::Joint(dWorldID world, std::string name, const JointConfig& config, dBodyID first, dBodyID second,
             const Pose& X_WV)
    : name_(std::move(name)), type_(config.type), kind_(kind_of(config.type)), axes_(axes_of(kind_)) {
  // ODE gets the moving body first: with the world first it would turn some signs around, but not all.
  sign_ = first != nullptr && second != nullptr ? -1 : 1;
  if (first == nullptr) std::swap(first, second);
  create(world, config, X_WV, first, second);
  if (axes_ > 0) configure_axis(config.axis1, 0);
  if (axes_ > 1) configure_axis(config.axis2, 1);
  for (int axis = 0; axis < axes_; ++axis) wrapped_[axis] = wrapped_position(axis);
}

void Joint::create(dWorldID world, const JointConfig& config, const Pose& X_WV, dBodyID first, dBodyID second) {
  const Vector3d anchor = X_WV * config.anchor_m;
  const Vector3d axis1 = (X_WV.linear() * config.axis1.axis).normalized();
  const Vector3d axis2 = (X_WV.linear() * config.axis2.axis).normalized();
  const auto attach = [&](dJointID joint) {
    ode_.reset(joint);
    dJointAttach(joint, first, second);
    return joint;
  };
  if (kind_ == dJointTypeFixed) {
    dJointSetFixed(attach(dJointCreateFixed(world, nullptr)));
  } else if (kind_ == dJointTypeBall) {
    dJointSetBallAnchor(attach(dJointCreateBall(world, nullptr)), anchor.x(), anchor.y(), anchor.z());
  } else if (kind_ == dJointTypeHinge) {
    const dJointID joint = attach(dJointCreateHinge(world, nullptr));
    dJointSetHingeAnchor(joint, anchor.x(), anchor.y(), anchor.z());
    dJointSetHingeAxis(joint, axis1.x(), axis1.y(), axis1.z());
  } else if (kind_ == dJointTypeSlider) {
    dJointSetSliderAxis(attach(dJointCreateSlider(world, nullptr)), axis1.x(), axis1.y(), axis1.z());
  } else if (kind_ == dJointTypeHinge2) {
    const dJointID joint = attach(dJointCreateHinge2(world, nullptr));
    const dVector3 a1 = {axis1.x(), axis1.y(), axis1.z(), 0}, a2 = {axis2.x(), axis2.y(), axis2.z(), 0};
    dJointSetHinge2Anchor(joint, anchor.x(), anchor.y(), anchor.z());
    dJointSetHinge2Axes(joint, a1, a2);
  } else {
    const dJointID joint = attach(dJointCreateUniversal(world, nullptr));
    dJointSetUniversalAnchor(joint, anchor.x(), anchor.y(), anchor.z());
    dJointSetUniversalAxis1(joint, axis1.x(), axis1.y(), axis1.z());
    dJointSetUniversalAxis2(joint, axis2.x(), axis2.y(), axis2.z());
  }
}

void Joint::configure_axis(const JointAxisConfig& config, int axis) {
  const auto set = [&](int parameter, const std::optional<double>& value) {
    if (value) set_parameter(parameter, *value, axis);
  };
  // Counted the other way round, the low stop is the high one.
  const bool turned = sign_ < 0;
  const std::optional<double>& low = turned ? config.high_stop : config.low_stop;
  const std::optional<double>& high = turned ? config.low_stop : config.high_stop;
  if (low) set_parameter(dParamLoStop, sign_ * *low, axis);
  if (high) set_parameter(dParamHiStop, sign_ * *high, axis);
  set(dParamBounce, config.bounce);
  set(dParamCFM, config.cfm);
  set(dParamERP, config.erp);
  set(dParamStopERP, config.stop_erp);
  set(dParamStopCFM, config.stop_cfm);
  set(dParamFudgeFactor, config.fudge_factor);
  set(dParamSuspensionERP, config.suspension_erp);
  set(dParamSuspensionCFM, config.suspension_cfm);
  if (config.motor_max_force > 0) set_motor(config.motor_velocity, config.motor_max_force, axis);
}

void Joint::set_parameter(int parameter, double value, int axis) {
  parameter += dParamGroup * axis;
  switch (kind_) {
    case dJointTypeHinge:
      return dJointSetHingeParam(ode_.get(), parameter, value);
    case dJointTypeSlider:
      return dJointSetSliderParam(ode_.get(), parameter, value);
    case dJointTypeHinge2:
      return dJointSetHinge2Param(ode_.get(), parameter, value);
    case dJointTypeUniversal:
      return dJointSetUniversalParam(ode_.get(), parameter, value);
    default:
      return;
  }
}

int Joint::max_rows() const {
  switch (kind_) {
    case dJointTypeBall:
      return 3;
    default:
      return 6;
  }
}

double Joint::velocity(int axis) const {
  switch (kind_) {
    case dJointTypeHinge:
      return sign_ * dJointGetHingeAngleRate(ode_.get());
    case dJointTypeSlider:
      return sign_ * dJointGetSliderPositionRate(ode_.get());
    case dJointTypeHinge2:
      return sign_ * (axis == 0 ? dJointGetHinge2Angle1Rate(ode_.get()) : dJointGetHinge2Angle2Rate(ode_.get()));
    case dJointTypeUniversal:
      return sign_ * (axis == 0 ? dJointGetUniversalAngle1Rate(ode_.get()) : dJointGetUniversalAngle2Rate(ode_.get()));
    default:
      return 0;
  }
}

double Joint::wrapped_position(int axis) const {
  switch (kind_) {
    case dJointTypeHinge:
      return sign_ * dJointGetHingeAngle(ode_.get());
    case dJointTypeSlider:
      return sign_ * dJointGetSliderPosition(ode_.get());
    case dJointTypeHinge2:
      return axis == 0 ? sign_ * dJointGetHinge2Angle1(ode_.get()) : 0;
    case dJointTypeUniversal:
      return sign_ * (axis == 0 ? dJointGetUniversalAngle1(ode_.get()) : dJointGetUniversalAngle2(ode_.get()));
    default:
      return 0;
  }
}

void Joint::update_position(double step_s) {
  if (kind_ == dJointTypeSlider) {
    position_[0] = wrapped_position(0);
    return;
  }
  for (int axis = 0; axis < axes_; ++axis) {
    const double expected = velocity(axis) * step_s;
    if (kind_ == dJointTypeHinge2 && axis == 1) {
      position_[1] += expected;
      continue;
    }
    const double wrapped = wrapped_position(axis);
    double moved = wrapped - wrapped_[axis];
    // ODE's angle jumps at pi.  The rate says how many turns the step made; the angle says the rest exactly.
    if (std::abs(moved - expected) > std::numbers::pi)
      moved += 2 * std::numbers::pi * std::round((expected - moved) / (2 * std::numbers::pi));
    wrapped_[axis] = wrapped;
    position_[axis] += moved;
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

void Joint::add_effort(double effort, int axis) {
  if (!std::isfinite(effort)) throw PhysicsFault("joint '" + name_ + "': an effort on it is not finite");
  const double torque1 = axis == 0 ? sign_ * effort : 0, torque2 = axis == 1 ? sign_ * effort : 0;
  switch (kind_) {
    case dJointTypeHinge:
      return dJointAddHingeTorque(ode_.get(), sign_ * effort);
    case dJointTypeSlider:
      return dJointAddSliderForce(ode_.get(), sign_ * effort);
    case dJointTypeHinge2:
      return dJointAddHinge2Torques(ode_.get(), torque1, torque2);
    case dJointTypeUniversal:
      return dJointAddUniversalTorques(ode_.get(), torque1, torque2);
    default:
      return;
  }
}

void Joint::hash_state(StateHash& hash) const {
  for (int axis = 0; axis < axes_; ++axis) {
    hash.add(position_[axis]);
    hash.add(wrapped_[axis]);
    hash.add(motor_velocity_[axis]);
    hash.add(motor_max_force_[axis]);
  }
}

}  // namespace sim
