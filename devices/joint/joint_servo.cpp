// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/joint_servo.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "devices/joint/joint_of_device.hpp"
#include "shoal/joint_command_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/config/message_text.hpp"

namespace devices {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Returns the highest velocity for this step from which it stops exactly after `distance`, when the velocity decreases
/// in each further step by change = acceleration * step_s.  With m such steps to come, v = m change + f and distance /
/// step_s = v + (v - change) + ... + f = (m + 1) (m change / 2 + f), 0 <= f <= change.
double stopping_velocity(double distance, double acceleration, double step_s) {
  if (distance <= 0) return 0;
  const double at_once = distance / step_s;
  if (std::isinf(acceleration) || std::isinf(distance)) return at_once;
  const double change = acceleration * step_s;
  const double m = std::floor((std::sqrt(1 + 8 * at_once / change) - 1) / 2);
  return m * change / 2 + at_once / (m + 1);
}

}  // namespace

void SetPoint::advance(double desired_velocity, const Limits& limits, double step_s) {
  const double change = limits.acceleration * step_s;
  velocity += std::clamp(desired_velocity - velocity, -change, change);
  position += velocity * step_s;
}

void SetPoint::approach(double target, const Limits& limits, double step_s) {
  const double distance = target - position;
  const double upper = std::min(limits.velocity, stopping_velocity(std::abs(distance), limits.acceleration, step_s));
  advance(std::copysign(upper, distance), limits, step_s);
  if (std::abs(target - position) < 1e-12) position = target;  // rounding
}

void SetPoint::run(double target_velocity, double low, double high, const Limits& limits, double step_s) {
  const double up = stopping_velocity(high - position, limits.acceleration, step_s);
  const double down = stopping_velocity(position - low, limits.acceleration, step_s);
  advance(std::clamp(std::clamp(target_velocity, -limits.velocity, limits.velocity), -down, up), limits, step_s);
}

void JointServo::Params::read(sim::ParamReader& in) {
  in.require("joint");
  in.read_reference("joint", joint, "joint", "joint that it drives");
  in.read("axis", axis, sim::between(0, 1), "axis of the joint: 1 is the second one of hinge2 and universal");
  in.read_choice("control", control, {{"velocity", Control::velocity}, {"pid", Control::pid}},
                 "velocity: a stiff velocity loop, stable at any step; pid: the effort is the sum of three terms");
  in.read("kp", kp, sim::at_least(0), "velocity: 1/s; pid: effort for an error, N m/rad or N/m");
  in.read("ki", ki, sim::at_least(0), "pid: effort for the integral of the error");
  in.read("kd", kd, sim::at_least(0), "pid: effort for an error of the velocity; stable below inertia / step");
  in.read("integral_limit", integral_limit, sim::at_least(0), "pid: maximum effort of the integral term");
  in.read("low", low, sim::any_number(), "lower limit of the position, rad or m; unset: the joint's stop");
  in.read("high", high, sim::any_number(), "upper limit of the position; unset: the joint's stop");
  in.read("max_velocity", max_velocity, sim::above(0),
          "maximum velocity of the setpoint, and beyond which an effort no longer acts");
  in.read("max_acceleration", max_acceleration, sim::above(0), "maximum acceleration of the setpoint; unset: no limit");
  in.read("max_effort", max_effort, sim::above(0), "maximum effort, N m or N");
  in.read("park_position", park_position, sim::any_number(), "position of the safe state 'park', rad or m");
  power.read(in);
  if (low && high && *low > *high) in.error("low", "'low' must not be above 'high'");
}

JointServo::JointServo(const Params& params, const sim::DeviceContext& context)
    : params_(params), joint_(joint_with_axis(context, params.joint, params.axis)), vehicle_(context.vehicle) {
  const sim::JointConfig& joint = joint_config(context.vehicle, params.joint);
  const sim::JointAxisConfig& axis = params.axis == 0 ? joint.axis1 : joint.axis2;
  low_stop_ = axis.low_stop;
  high_stop_ = axis.high_stop;
  // Check the range of the servo against the stops of the joint.
  using sim::number_text;
  if (params.low && high_stop_ && *params.low > *high_stop_)
    refuse(context, "'low' is outside the joint's stops: " + number_text(*params.low) + " is above 'high_stop', " +
                        number_text(*high_stop_));
  if (params.high && low_stop_ && *params.high < *low_stop_)
    refuse(context, "'high' is outside the joint's stops: " + number_text(*params.high) + " is below 'low_stop', " +
                        number_text(*low_stop_));
  find_range();
  set_point_.position = target_ = joint_.position(params_.axis);
}

void JointServo::find_range() {
  const double low_stop = low_stop_.value_or(-unlimited), high_stop = high_stop_.value_or(unlimited);
  low_ = std::clamp(params_.low.value_or(-unlimited), low_stop, high_stop);
  high_ = std::clamp(params_.high.value_or(unlimited), low_stop, high_stop);
}

void JointServo::change(const Params& params) {
  params_ = params;
  find_range();  // limits the target to a reduced range
  if (mode_ == Mode::position) target_ = std::clamp(target_, low_, high_);
}

void JointServo::move_set_point(double step_s) {
  if (follows_) {
    set_point_.position = joint_.position(params_.axis);
    set_point_.velocity = joint_.velocity(params_.axis);
    integral_ = 0;
    follows_ = false;
  }
  const SetPoint::Limits limits{params_.max_velocity, params_.max_acceleration.value_or(unlimited)};
  if (mode_ == Mode::position)
    set_point_.approach(target_, limits, step_s);
  else
    set_point_.run(target_, low_, high_, limits, step_s);
}

double JointServo::pid_effort(double max_effort, double step_s) {
  // Limit the distance to the joint, so that a blocked joint does not accumulate motion.
  if (mode_ == Mode::velocity && params_.kp > 0) {
    const double slack = params_.max_effort / params_.kp;
    const double position = joint_.position(params_.axis);
    set_point_.position = std::clamp(set_point_.position, position - slack, position + slack);
  }
  const double proportional = params_.kp * error() + params_.kd * (set_point_.velocity - joint_.velocity(params_.axis));
  const double more = params_.ki * error() * step_s;
  // Anti-windup: no integration while the effort is limited.
  if (std::abs(proportional + integral_ + more) <= max_effort || more * integral_ < 0)
    integral_ = std::clamp(integral_ + more, -params_.integral_limit, params_.integral_limit);
  return std::clamp(proportional + integral_, -max_effort, max_effort);
}

double JointServo::cut_effort(double max_effort) const {
  const double effort = std::clamp(target_, -max_effort, max_effort);
  const double velocity = joint_.velocity(params_.axis);
  const bool too_fast = std::abs(velocity) >= params_.max_velocity && velocity * effort > 0;
  return too_fast ? 0 : effort;
}

void JointServo::act(const sim::ActContext& context) {
  if (vehicle_.systems().metered) joint_.measure_load();
  const double max_effort = mode_ == Mode::coast ? 0 : context.effectiveness * params_.max_effort;
  applied_ = 0;
  // Effort command, or no effort.
  if (max_effort == 0 || mode_ == Mode::effort) {
    joint_.set_motor(0, 0, params_.axis);
    follows_ = true;
    if (max_effort > 0) applied_ = cut_effort(max_effort);
  } else {
    // The velocity motor moves the joint during the whole step, from the setpoint at its start.
    const bool was_following = follows_;
    const double error_before = was_following ? 0 : error();
    move_set_point(context.step_s);
    if (params_.control == Control::velocity) {
      // Correct at most the whole error in a step, to avoid oscillation.
      const double gain = std::min(params_.kp, 1 / context.step_s);
      const double desired = set_point_.velocity + gain * error_before;
      joint_.set_motor(std::clamp(desired, -params_.max_velocity, params_.max_velocity), max_effort, params_.axis);
      return;
    }
    joint_.set_motor(0, 0, params_.axis);
    applied_ = pid_effort(max_effort, context.step_s);
  }
  if (applied_ != 0) joint_.add_effort(applied_, params_.axis);
}

void JointServo::make_safe(sim::SafeState safe) {
  switch (safe) {
    case sim::SafeState::coast:
      return coast();
    case sim::SafeState::stop:
      return set_velocity(0);
    case sim::SafeState::park:
      return set_position(params_.park_position);
    case sim::SafeState::hold:
      set_position(joint_.position(params_.axis));
      set_point_ = {};
      set_point_.position = target_;
      integral_ = 0;
      follows_ = false;
  }
}

double JointServo::power_W() const {
  if (joint_.motor_max_force(params_.axis) > 0) return params_.power.of_motor(joint_, params_.axis, params_.max_effort);
  return params_.power.of(applied_, joint_.velocity(params_.axis), params_.max_effort);
}

void JointServo::set_position(double position) {
  mode_ = Mode::position;
  target_ = std::clamp(position, low_, high_);
}

void JointServo::set_velocity(double velocity) {
  mode_ = Mode::velocity;
  target_ = std::clamp(velocity, -params_.max_velocity, params_.max_velocity);
}

void JointServo::set_effort(double effort) {
  mode_ = Mode::effort;
  target_ = std::clamp(effort, -params_.max_effort, params_.max_effort);
}

void JointServo::visit_state(sim::StateArchive& archive) {
  archive(mode_, target_, set_point_, follows_, integral_, applied_);
  if (mode_ < Mode::position || mode_ > Mode::coast) archive.fail("unknown mode of a servo");
}

void JointServoController::receive(sim::Time, std::span<const std::byte> payload) {
  using shoal::Finite;
  if (shoal::fingerprint(payload) == shoal::fingerprint_of<shoal::joint_command_t>()) {
    servo_.set_velocity(shoal::decode<shoal::joint_command_t>(payload, Finite::required).velocity);
    return;
  }
  const auto command = shoal::decode<shoal::joint_servo_command_t>(payload, Finite::required);
  switch (command.mode) {
    case 0:
      return servo_.set_position(command.position);
    case 1:
      return servo_.set_velocity(command.velocity);
    case 2:
      return servo_.set_effort(command.effort);
    case 3:
      return servo_.coast();
    default:
      throw std::runtime_error("'mode' must be 0 (position), 1 (velocity), 2 (effort) or 3 (coast), got " +
                               std::to_string(static_cast<int>(command.mode)));
  }
}

SHOAL_ACTUATOR("joint_servo", JointServo, JointServoController);

}  // namespace devices
