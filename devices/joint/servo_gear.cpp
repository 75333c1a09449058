// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/servo_gear.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace devices {

namespace {

constexpr double at_rest = 1e-5;  // rad/s or m/s: above the rate of a motor that holds, which is soft by the cfm

constexpr double without_limit = std::numeric_limits<double>::infinity();

double sign(double number) {
  return number < 0 ? -1 : 1;
}

}  // namespace

void ServoGear::Params::read(sim::ParamReader& in) {
  line.read(in);
  in.read("friction", friction, sim::at_least(0), "Coulomb friction of motor and gear at the joint, N m or N");
  in.read("play", play, sim::at_least(0), "free travel of the joint between both directions of the gear, rad or m");
}

void ServoGear::restart() {
  position_ = joint_.position(axis_);
  velocity_ = joint_.velocity(axis_);
  pushed_ = limit_ = motor_effort_ = 0;
  running_ = false;
  contact_ = Contact::none;
}

void ServoGear::visit_state(sim::StateArchive& archive) {
  archive(position_, velocity_, pushed_, limit_, motor_effort_, running_, contact_);
  archive.require(limit_, 0, sim::StateArchive::max_number, "the limit of a servo's motor");
}

void ServoGear::start_step(double max_effort, double share, double step_s) {
  max_effort_ = max_effort;
  share_ = share;
  step_s_ = step_s;
  if (params_.is_ideal()) return;
  velocity_before_ = std::exchange(velocity_, joint_.velocity(axis_));
  effort_ = joint_.effort(axis_);
  mobility_ = joint_.mobility(axis_);
  // Separate the effort of the motor from the friction, which opposes motion and otherwise helps to hold.
  if (running_) {
    const double friction =
        moves() ? -sign(velocity_) * params_.friction : std::clamp(effort_, -params_.friction, params_.friction);
    motor_effort_ = std::clamp(effort_ - friction, -limit_, limit_);
  } else {
    motor_effort_ = pushed_;
  }
  // The load that it touches moves the motor side too.
  const double half = params_.play / 2, joint = joint_.position(axis_);
  if (contact_ != Contact::none || half == 0) position_ = std::clamp(position_, joint - half, joint + half);
}

bool ServoGear::moves() const {
  return std::abs(velocity_) > at_rest;
}

double ServoGear::max_effort(double direction) const {
  if (!params_.line.has()) return max_effort_;
  const double forward = sign(direction), velocity = forward * velocity_;
  return std::min(max_effort_,
                  params_.line.max_effort({.velocity = velocity,
                                           .velocity_before = forward * velocity_before_,
                                           .effort_before = forward * effort_,
                                           .friction = velocity < -at_rest ? -params_.friction : params_.friction,
                                           .mobility = mobility_},
                                          share_, step_s_));
}

/// Effort that brings the joint to a velocity at the end of this step, unless the load changes: load = effort -
/// (velocity - velocity_before) / (mobility step) of the last step.  With a mobility above the true one it is between
/// this load and the true effort.
double ServoGear::effort_to(double velocity) const {
  return effort_ + (velocity - 2 * velocity_ + velocity_before_) / (mobility_ * step_s_);
}

/// Side on which the motor side, with a velocity, will touch the load at the end of the step.
ServoGear::Contact ServoGear::contact_at(double motor_velocity) const {
  const double half = params_.play / 2;
  const double travel = joint_.position(axis_) - position_ + (velocity_ - motor_velocity) * step_s_;
  const Contact contact = travel <= -half ? Contact::up : travel >= half ? Contact::down : Contact::none;
  // A motor does not pull: the load leaves it.
  if (contact == contact_ && ((contact == Contact::up && effort_ < 0) || (contact == Contact::down && effort_ > 0)))
    return Contact::none;
  return contact;
}

/// Velocity at which the load ends the step at the motor side.
double ServoGear::velocity_to(Contact contact, double motor_velocity) const {
  const double half = contact == Contact::up ? -params_.play / 2 : params_.play / 2;
  return motor_velocity + (position_ + half - joint_.position(axis_)) / step_s_;
}

void ServoGear::run_at(double velocity) {
  if (params_.is_ideal()) return joint_.set_motor(velocity, max_effort_, axis_);
  running_ = true;
  pushed_ = limit_ = 0;
  if (params_.play == 0) return drive(velocity, sign(effort_to(velocity)));
  // The motor side moves freely, or pushes the load.
  const double free = max_effort_ <= params_.friction ? 0 : params_.line.no_load_velocity.value_or(without_limit);
  velocity = std::clamp(velocity, -free, free);
  contact_ = contact_at(velocity);
  const double closing = velocity_to(contact_, velocity), direction = contact_ == Contact::down ? -1 : 1;
  if (direction * effort_to(closing) < 0) contact_ = Contact::none;
  position_ += velocity * step_s_;
  if (contact_ == Contact::none)
    joint_.set_motor(0, 0, axis_);
  else
    drive(closing, direction);
}

/// Runs the joint at a velocity with the motor of the physics, whose one limit combines the efforts of the motor and of
/// the friction.  `direction`: sign of the effort.
void ServoGear::drive(double velocity, double direction) {
  limit_ = max_effort(direction);
  const double friction = params_.friction, surplus = limit_ - friction;
  const double load = direction * effort_to(velocity_);
  // To brake and to hold, motor and friction act together; to drive, the motor acts against the friction.
  const bool drives = direction * velocity > 0;
  const bool blocked = drives && friction > 0 && load >= surplus && direction * velocity_ <= at_rest;
  if (blocked) return joint_.set_motor(0, limit_ + friction, axis_);
  joint_.set_motor(velocity, drives ? std::max(surplus, 0.0) : limit_ + friction, axis_);
}

void ServoGear::push(double effort, double free_velocity) {
  // An ideal gear takes the effort without the friction motor, whose constraint row would cost time in each step.
  if (params_.is_ideal()) {
    joint_.set_motor(0, 0, axis_);
    if (effort != 0) joint_.add_effort(effort, axis_);
    return;
  }
  running_ = false;
  double friction = params_.friction;
  if (params_.play > 0) {
    if (std::abs(effort) <= friction) free_velocity = 0;
    contact_ = contact_at(free_velocity);
    position_ += free_velocity * step_s_;
    // A motor only pushes against the side of the play that it touches; in between it accelerates nothing, and the
    // joint is free.
    const bool pushes = (contact_ == Contact::up && effort > 0) || (contact_ == Contact::down && effort < 0);
    if (!pushes) effort = 0;
    if (contact_ == Contact::none) friction = 0;
  }
  pushed_ = effort;
  joint_.set_motor(0, friction, axis_);
  if (effort != 0) joint_.add_effort(effort, axis_);
}

}  // namespace devices
