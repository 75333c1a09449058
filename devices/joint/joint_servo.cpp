// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/joint_servo.hpp"

#include <cmath>
#include <limits>

#include "devices/joint/joint_of_device.hpp"
#include "sim/config/message_text.hpp"

namespace devices {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double min_servo_limit = 1e-9;  // quotients by a limit stay finite

}  // namespace

void JointServo::Params::read(sim::ParamReader& in) {
  in.require("joint");
  in.read_reference("joint", joint, "joint", "joint that it drives");
  in.read("axis", axis, sim::between(0, 1), "axis of the joint: 1 is the second one of hinge2 and universal");
  in.read("alias", alias, "another name of this servo in groups and motions, such as the robot maker's");
  in.read_choice("control", control, {{"velocity", Control::velocity}, {"pid", Control::pid}},
                 "velocity: a stiff velocity loop, stable at any step; pid: the effort is the sum of three terms");
  in.read("kp", kp, sim::at_least(0), "velocity: 1/s; pid: effort for an error, N m/rad or N/m");
  in.read("ki", ki, sim::at_least(0), "pid: effort for the integral of the error");
  in.read("kd", kd, sim::at_least(0), "pid: effort for an error of the velocity; stable below inertia / step");
  in.read("integral_limit", integral_limit, sim::at_least(0), "pid: maximum effort of the integral term");
  in.read("low", low, sim::any_number(), "lower limit of the position, rad or m; unset: the joint's stop");
  in.read("high", high, sim::any_number(), "upper limit of the position; unset: the joint's stop");
  in.read("max_velocity", max_velocity, sim::at_least(min_servo_limit),
          "maximum velocity of the setpoint, and beyond which an effort no longer acts");
  in.read("max_acceleration", max_acceleration, sim::at_least(min_servo_limit),
          "maximum acceleration of the setpoint; unset: no limit");
  in.read("max_effort", max_effort, sim::at_least(min_servo_limit), "maximum effort, N m or N");
  in.read("park_position", park_position, sim::any_number(), "position of the safe state 'park', rad or m");
  in.read("deadband", deadband, sim::at_least(0), "error of the position that it does not correct, rad or m");
  in.read("command_quantum", command_quantum, sim::at_least(0),
          "commanded positions are rounded to multiples of this, rad or m; 0: they are not");
  gear.read(in);
  in.read("overload", overload,
          "switches it off at too much effort for too long, until a command of mode 4; unset: never");
  power.read(in);
  if (low && high && *low > *high) in.error("low", "'low' must not be above 'high'");
}

JointServo::JointServo(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      joint_(joint_with_axis(context, params.joint, params.axis)),
      vehicle_(context.vehicle),
      warnings_(context.host.warnings),
      full_name_(context.full_name()),
      gear_(params_.gear, joint_, params.axis) {
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
  gear_.restart();
}

void JointServo::find_range() {
  const double low_stop = low_stop_.value_or(-unlimited), high_stop = high_stop_.value_or(unlimited);
  low_ = std::clamp(params_.low.value_or(-unlimited), low_stop, high_stop);
  high_ = std::clamp(params_.high.value_or(unlimited), low_stop, high_stop);
}

void JointServo::change(const Params& params) {
  const bool was_ideal = params_.gear.is_ideal();
  params_ = params;
  if (was_ideal) gear_.restart();
  if (!params_.overload) overload_.reset();
  find_range();  // limits the target to a reduced range
  if (mode_ == Mode::position) target_ = std::clamp(target_, low_, high_);
}

void JointServo::move_set_point(double step_s) {
  // After coasting the set point starts where the joint is, or the servo would jerk it back.
  if (follows_) {
    set_point_.position = gear_.position();
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

/// Returns the error outside of the deadband.
double JointServo::error() const {
  const double error = set_point_.position - gear_.position();
  return params_.deadband == 0 ? error : error - std::clamp(error, -params_.deadband, params_.deadband);
}

double JointServo::pid_effort(double step_s) {
  // Limit the distance to the joint, so that a blocked joint does not accumulate motion.
  if (mode_ == Mode::velocity && params_.kp > 0) {
    const double slack = params_.max_effort / params_.kp;
    const double position = gear_.position();
    set_point_.position = std::clamp(set_point_.position, position - slack, position + slack);
  }
  const double proportional = params_.kp * error() + params_.kd * (set_point_.velocity - joint_.velocity(params_.axis));
  const double more = params_.ki * error() * step_s;
  const double max_effort = gear_.max_effort(proportional + integral_);
  // Anti-windup: no integration while the effort is limited.
  if (std::abs(proportional + integral_ + more) <= max_effort || more * integral_ < 0)
    integral_ = std::clamp(integral_ + more, -params_.integral_limit, params_.integral_limit);
  return std::clamp(proportional + integral_, -max_effort, max_effort);
}

double JointServo::cut_effort() const {
  const double max_effort = gear_.max_effort(target_);
  const double effort = std::clamp(target_, -max_effort, max_effort);
  const double velocity = joint_.velocity(params_.axis);
  const bool too_fast = std::abs(velocity) >= params_.max_velocity && velocity * effort > 0;
  return too_fast ? 0 : effort;
}

/// Velocity of a motor without load: to the setpoint, or in the direction of the commanded effort.
double JointServo::free_velocity(double step_s) const {
  const double desired =
      mode_ == Mode::effort ? target_ * unlimited : (set_point_.position - gear_.position()) / step_s;
  return std::clamp(desired, -params_.max_velocity, params_.max_velocity);
}

void JointServo::watch_load(double step_s) {
  const double of_motor = std::clamp(joint_.effort(params_.axis), -joint_.motor_max_force(params_.axis),
                                     joint_.motor_max_force(params_.axis));
  const double effort = params_.gear.is_ideal() ? of_motor + applied_ : gear_.motor_effort();
  const double largest = std::min(params_.max_effort, params_.gear.line.stall_effort.value_or(unlimited));
  if (!overload_.add(*params_.overload, std::abs(effort) / largest, step_s)) return;
  warnings_.device_fault(full_name_, "overload: its mean effort of " + sim::number_text(params_.overload->window_s) +
                                         " s is above " + sim::number_text(100 * params_.overload->share) +
                                         " % of the largest one; it is off until its command 'reset'");
}

void JointServo::act(const sim::ActContext& context) {
  if (vehicle_.systems().metered || !params_.gear.is_ideal() || params_.overload) joint_.measure_load();
  const double usable = mode_ == Mode::coast || is_off() ? 0 : context.effectiveness;
  const double max_effort = usable * params_.max_effort;
  gear_.start_step(max_effort, usable, context.step_s);
  if (params_.overload) watch_load(context.step_s);
  applied_ = 0;
  // Effort command, or no effort.
  if (max_effort == 0 || mode_ == Mode::effort) {
    follows_ = true;
    if (max_effort > 0) applied_ = cut_effort();
    gear_.push(applied_, applied_ == 0 ? 0 : free_velocity(context.step_s));
    return;
  }
  // The velocity motor moves the joint during the whole step, from the setpoint at its start.
  const double error_before = follows_ ? 0 : error();
  move_set_point(context.step_s);
  if (params_.control == Control::velocity) {
    // Correct at most the whole error in a step, to avoid oscillation.
    const double gain = std::min(params_.kp, 1 / context.step_s);
    const double desired = set_point_.velocity + gain * error_before;
    gear_.run_at(std::clamp(desired, -params_.max_velocity, params_.max_velocity));
    return;
  }
  applied_ = pid_effort(context.step_s);
  gear_.push(applied_, free_velocity(context.step_s));
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
      return hold();
  }
}

void JointServo::hold() {
  mode_ = Mode::position;
  target_ = std::clamp(gear_.position(), low_, high_);
  set_point_ = {};
  set_point_.position = target_;
  integral_ = 0;
  follows_ = false;
}

void JointServo::reset() {
  if (!is_off()) return;
  overload_.reset();
  hold();
}

double JointServo::power_W() const {
  if (!params_.gear.is_ideal())
    return params_.power.of(gear_.motor_effort(), joint_.velocity(params_.axis), params_.max_effort);
  if (joint_.motor_max_force(params_.axis) > 0) return params_.power.of_motor(joint_, params_.axis, params_.max_effort);
  return params_.power.of(applied_, joint_.velocity(params_.axis), params_.max_effort);
}

void JointServo::set_position(double position) {
  if (is_off()) return;
  mode_ = Mode::position;
  if (params_.command_quantum > 0) position = params_.command_quantum * std::round(position / params_.command_quantum);
  target_ = std::clamp(position, low_, high_);
}

void JointServo::set_velocity(double velocity) {
  if (is_off()) return;
  mode_ = Mode::velocity;
  target_ = std::clamp(velocity, -params_.max_velocity, params_.max_velocity);
}

void JointServo::set_effort(double effort) {
  if (is_off()) return;
  mode_ = Mode::effort;
  target_ = std::clamp(effort, -params_.max_effort, params_.max_effort);
}

void JointServo::coast() {
  if (!is_off()) mode_ = Mode::coast;
}

void JointServo::visit_state(sim::StateArchive& archive) {
  archive(mode_, target_, set_point_, follows_, integral_, applied_);
  if (!params_.gear.is_ideal()) archive(gear_);
  if (params_.overload) archive(overload_);
  if (mode_ < Mode::position || mode_ > Mode::coast) archive.fail("unknown mode of a servo");
}

}  // namespace devices
