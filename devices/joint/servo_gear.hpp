// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/joint/torque_speed_line.hpp"
#include "sim/physics/joint.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// Motor and gear between a servo and one axis of its joint: torque-speed line, Coulomb friction and play.
///
/// The play is free travel between the motor side, which the servo measures and controls, and the load side, which is
/// the joint.  The motor side has no inertia.  The friction acts on the motor side.  Without any of them the servo acts
/// on the joint itself.
class ServoGear {
 public:
  struct Params {
    TorqueSpeedLine line;
    double friction = 0;  ///< N m or N
    double play = 0;      ///< rad or m, the whole free travel

    void read(sim::ParamReader& in);
    bool is_ideal() const { return !line.has() && friction == 0 && play == 0; }
  };

  /// `params` and `joint` must outlive this.
  ServoGear(const Params& params, sim::Joint& joint, int axis) : params_(params), joint_(joint), axis_(axis) {}

  /// Starts a step.  `max_effort`: limit of the effort; `share`: available share of the stall effort.
  void start_step(double max_effort, double share, double step_s);
  /// Returns the largest effort of this step in the direction of a number.
  double max_effort(double direction) const;
  /// Runs the motor side at a velocity in this step.
  void run_at(double velocity);
  /// Applies an effort of the motor in this step.  `free_velocity`: of the motor side while it does not touch the load.
  void push(double effort, double free_velocity);

  /// Returns the position of the motor side.
  double position() const { return params_.play == 0 ? joint_.position(axis_) : position_; }
  /// Returns the effort of the motor in the last step; for a gear that is not ideal.
  double motor_effort() const { return motor_effort_; }
  /// Moves the motor side to the middle of the play, after a change of the parameters from an ideal gear.
  void restart();
  /// Visits the state of a gear that is not ideal.
  void visit_state(sim::StateArchive& archive);

 private:
  /// Side of the play on which the motor touches the load, as the direction in which it can push it.
  enum class Contact : signed char { none, up, down };

  Contact contact_at(double motor_velocity) const;
  double velocity_to(Contact contact, double motor_velocity) const;
  double effort_to(double velocity) const;
  void drive(double velocity, double direction);
  bool moves() const;

  const Params& params_;
  sim::Joint& joint_;
  int axis_;
  double max_effort_ = 0, share_ = 0, step_s_ = 0;  // of this step
  double velocity_before_ = 0, mobility_ = 0;       // of this step
  double effort_ = 0;                               // of all on the joint in the last step
  double position_ = 0;                             // of the motor side
  double velocity_ = 0;                             // of the joint at the start of the step
  double pushed_ = 0;                               // effort of the motor by push()
  double limit_ = 0;                                // of the motor's effort by run_at()
  double motor_effort_ = 0;
  bool running_ = false;  // run_at() in this step
  Contact contact_ = Contact::none;
};

}  // namespace devices
