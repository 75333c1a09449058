// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/drive/wheel_motors.hpp"
#include "devices/joint/joint_power.hpp"

namespace devices {

/// Car-like drive: two steered front wheels and driven wheels, as on a car.  All wheels are perpendicular to the lines
/// to one turning center on the line of the rear axle: for the steering angle d of a virtual wheel in the middle of the
/// front axle, wheelbase L and track t, tan d_left = L tan d / (L - t/2 tan d), with + for the right wheel (Rajamani,
/// Vehicle Dynamics and Control, 2nd ed., 2012).
class AckermannDrive final : public sim::Actuator {
 public:
  static constexpr const char* example =
      "left_steer_joint: front_left, right_steer_joint: front_right, drive_joints: [left, right]";
  static constexpr const char* meaning =
      "Steered front wheels and driven wheels, commanded by speed and steering, by twist, or by thrust and rudder.";
  static constexpr bool acts_alone = true;
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::coast};
  static constexpr const char* fixed_keys[] = {"left_steer_joint", "right_steer_joint", "drive_joints"};
  struct Params {
    std::string left_steer_joint;
    std::string right_steer_joint;
    std::vector<std::string> drive_joints;
    std::optional<double> wheelbase_m, track_m, wheel_radius_m;  ///< unset: from the joints and wheels
    bool differential = true;
    double max_speed_mps = 2;
    double max_acceleration_mps2 = 2;
    double max_torque_Nm = 1;
    double max_steering_rad = 0.5;
    double max_steering_rate_radps = 3;
    double max_steering_torque_Nm = 1;
    MotorPower power;
    void read(sim::ParamReader& in);
  };

  AckermannDrive(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context) override;
  /// Applies a safe state.  stop: brakes and holds the steering angle; coast: wheels and steering are free.
  void make_safe(sim::SafeState safe) override;
  void change(const Params& params);
  double power_W() const override;
  void visit_state(sim::StateArchive& archive) override;

  /// Commands the speed of the middle of the rear axle, and the steering angle in the middle of the front axle.
  void set_steering(double speed_mps, double steering_rad);
  /// Commands a twist, with turn rate = speed * tan(steering) / wheelbase.  It cannot turn on the spot: at zero speed
  /// it only steers.
  void set_twist(double forward_mps, double turn_radps);
  /// Commands thrust, which sets the speed, and rudder, which sets the steering angle.
  void set_thrust_rudder(double thrust, double rudder);
  double steering_rad() const { return steering_rad_; }

 private:
  struct DrivenWheel {
    WheelMotors motors;
    double x_m, y_m;  ///< from the middle of the front axle: forward, left
  };
  void clamp_targets();
  /// Lengths from the joints and wheels, for those that `params_` does not set.
  struct Lengths {
    double wheelbase_m = 0.3, track_m = 0.2, wheel_radius_m = 0.05;
  };
  void take_lengths(const sim::DeviceContext& context);
  void check_stops(const sim::DeviceContext& context) const;
  Lengths lengths_of(const Params& params) const;
  void steer(sim::Joint& joint, double side, double torque_Nm, double step_s);
  /// Returns the ratio of the ground speed of a wheel that rolls without slip to that of the middle of the rear axle.
  double speed_ratio(const DrivenWheel& wheel) const;

  Params params_;
  Lengths of_joints_, lengths_;
  const sim::Vehicle& vehicle_;
  sim::Joint* steer_[2];  ///< left, right
  std::vector<DrivenWheel> wheels_;
  double target_mps_ = 0, target_steering_rad_ = 0;
  double speed_mps_ = 0, steering_rad_ = 0;  ///< present setpoints, which approach the targets
  bool coasting_ = false;
};

/// Receives shoal.ackermann_command_t, shoal.twist_command_t or shoal.thrust_rudder_command_t, distinguished by their
/// fingerprints.
class AckermannDriveController final : public sim::Controller {
 public:
  static constexpr const char* command_messages =
      "shoal.ackermann_command_t, shoal.twist_command_t, shoal.thrust_rudder_command_t";
  explicit AckermannDriveController(AckermannDrive& drive) : drive_(drive) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  AckermannDrive& drive_;
};

}  // namespace devices
