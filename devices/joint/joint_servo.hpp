// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "devices/joint/joint_power.hpp"
#include "devices/joint/servo_gear.hpp"
#include "devices/joint/servo_overload.hpp"
#include "devices/joint/set_point.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

/// Servo that drives one axis of a joint to a position, at a velocity or with an effort.
///
/// Position and velocity commands move a setpoint with limited velocity and acceleration.  `control: velocity` uses
/// the velocity motor of the physics: velocity = setpoint velocity + kp * error.  `control: pid` applies the effort kp
/// * error + ki * integral of the error + kd * velocity error.  An effort command applies that effort.
/// The gear acts on the joint: docs/models/joint_servos.md.
class JointServo final : public sim::Actuator {
 public:
  static constexpr const char* meaning = "Servo on one axis of a joint, commanded by position, velocity or effort.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::hold, sim::SafeState::coast, sim::SafeState::stop,
                                                   sim::SafeState::park};
  static constexpr const char* fixed_keys[] = {"joint", "axis", "alias"};
  enum class Mode { position, velocity, effort, coast };
  enum class Control { velocity, pid };
  struct Params {
    std::string joint;
    int axis = 0;
    std::string alias;  ///< another name of the servo in groups and motion files; empty: none
    Control control = Control::velocity;
    double kp = 20;
    double ki = 0;
    double kd = 0;
    double integral_limit = 0;  ///< limit of the effort of the integral term
    std::optional<double> low;
    std::optional<double> high;
    double max_velocity = 1;
    std::optional<double> max_acceleration;
    double max_effort = 10;
    double park_position = 0;
    double deadband = 0;         ///< error of the position that is not corrected, rad or m
    double command_quantum = 0;  ///< resolution of commanded positions, rad or m; 0: exact
    ServoGear::Params gear;
    std::optional<ServoOverload::Params> overload;
    MotorPower power;
    void read(sim::ParamReader& in);
  };

  JointServo(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context) override;
  /// Applies a safe state.  hold: holds the present position; stop: slows down to rest; coast: no effort; park: moves
  /// to `park_position`.
  void make_safe(sim::SafeState safe) override;
  void change(const Params& params);
  double power_W() const override;
  void visit_state(sim::StateArchive& archive) override;

  /// Command a position, velocity or effort, which are limited.  Without effect while the overload protection has
  /// switched the servo off.
  void set_position(double position);
  void set_velocity(double velocity);
  void set_effort(double effort);
  void coast();
  /// Switches the servo on again after an overload: it holds its present position.  No effect while it is on.
  void reset();
  bool is_off() const { return overload_.is_off(); }
  const SetPoint& set_point() const { return set_point_; }
  double joint_position() const { return joint_.position(params_.axis); }
  const std::string& alias() const { return params_.alias; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  void find_range();
  void move_set_point(double step_s);
  double pid_effort(double step_s);
  double cut_effort() const;
  double error() const;
  double free_velocity(double step_s) const;
  void hold();
  void watch_load(double step_s);

  Params params_;
  sim::Joint& joint_;
  const sim::Vehicle& vehicle_;
  sim::WorldWarnings& warnings_;
  std::string full_name_;
  std::optional<double> low_stop_, high_stop_;
  double low_, high_;
  Mode mode_ = Mode::position;  ///< until the first command it holds its position
  double target_ = 0;           ///< target in the unit of the mode
  SetPoint set_point_;
  bool follows_ = false;  ///< without effort the setpoint tracks the joint, to avoid a jump afterwards
  double integral_ = 0;   ///< effort
  double applied_ = 0;    ///< effort of the last step, when applied by this class
  ServoGear gear_;
  ServoOverload overload_;
};

/// Receives shoal.joint_servo_command_t, or shoal.joint_command_t for a velocity, distinguished by their fingerprints.
class JointServoController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.joint_servo_command_t, shoal.joint_command_t";
  explicit JointServoController(JointServo& servo) : servo_(servo) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  JointServo& servo_;
};

}  // namespace devices
