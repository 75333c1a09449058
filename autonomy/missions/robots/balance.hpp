// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "autonomy/missions/robots/tilt_filter.hpp"
#include "shoal/imu_t.hpp"
#include "shoal/inclination_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/wheel_encoder_t.hpp"

namespace autonomy {

/// Speed and yaw rate from a time on.
struct SpeedPoint {
  double from_s = 0;
  double forward_mps = 0;
  double turn_radps = 0;
};
/// Throws std::invalid_argument when the times do not increase.
void check_speeds(const std::vector<SpeedPoint>& points);

/// Balances a two-wheeled inverted pendulum and drives it: a PD law from tilt to torque of the wheels, and an outer PI
/// law from speed to tilt.  A pure function of the messages in their order, independent of clock and bus.
///
///     torque = kp (tilt - desired) + kd rate
///     desired = balanced tilt + kv (desired speed - speed) + ki * integral of that
///
/// Tilt and rate are positive forwards.  To accelerate it must tilt forwards, so at first it rolls back a little.  A
/// commanded tilt replaces the second law: it accelerates until it is as fast as `max_tilt_speed_mps`.  From the first
/// one on, the TiltFilter gets the inclination without its error by the acceleration of the wheels, which tilts make
/// much longer and larger than commands of the speed.
class Balance {
 public:
  struct Params {
    double period_s = 0.01;               ///< between two calls of step()
    double balanced_tilt_rad = -0.17323;  ///< where the center of mass is over the axle
    double kp_Nm_per_rad = 300;           ///< both wheels together; less than m g l = 129 cannot balance it
    double kd_Nms_per_rad = 60;
    double kv_rad_per_mps = 0.12;
    double ki_rad_per_m = 0.02;
    double max_tilt_rad = 0.2;  ///< of the desired tilt, from the balanced one
    double max_acceleration_mps2 = 0.5;
    double max_tilt_speed_mps = 1.5;       ///< a commanded tilt is taken back towards this speed, above 0
    double tilt_torque_Nm_per_rad = 78.9;  ///< keeps a commanded tilt while it accelerates, see hold_torque()
    double turn_gain_Nms_per_rad = 40;     ///< differential wheel torque per yaw rate error
    double turn_ki_Nm_per_rad = 120;       ///< gain of its integral: wide wheels scrub on the ground
    double rate_filter_s = 0.005;          ///< low pass on the rate of the tilt
    double speed_filter_s = 0.05;          ///< low pass on speed and turn rate
    double filter_s = 0;                   ///< time constant of the TiltFilter; 0: none, and no IMU
    double wheel_radius_m = 0.236;
    double track_m = 0.57;      ///< between the middles of its wheels, on which they turn
    double max_torque_Nm = 50;  ///< of each wheel
    double fallen_rad = 0.8;    ///< tilt from the balanced one at which it gives up
  };
  struct Torques {
    double left_Nm = 0, right_Nm = 0;
  };

  /// Throws std::invalid_argument for invalid parameters.
  explicit Balance(const Params& params);
  void receive(const shoal::inclination_t& message);
  /// Gyro whose y axis is that of the tilt, for the TiltFilter.
  void receive(const shoal::imu_t& message);
  /// Left wheel first.  Throws shoal::MessageError when the number of wheels is not two.
  void receive(const shoal::wheel_encoder_t& message);
  void receive(const shoal::twist_command_t& message);
  void drive(double forward_mps, double turn_radps);
  /// Tilts by this from the balanced tilt, positive forwards, at the last turn rate, until drive() is called.
  void command_tilt(double from_balance_rad) {
    asked_tilt_rad_ = from_balance_rad;
    was_tilted_ = true;
  }

  /// Computes the torques after all reports up to now.  Nothing until tilt and wheels are known.
  std::optional<Torques> step();
  /// Returns whether it has fallen; from then on it commands no torque.
  bool fallen() const { return fallen_; }
  double tilt_rad() const { return tilt_rad_; }
  double rate_radps() const { return rate_radps_; }
  double speed_mps() const { return speed_mps_; }

 private:
  double without_acceleration(double inclination_rad) const;
  void take_rate(double rate_radps, double dt_s);
  double tilt_for_speed();
  double tilt_for_command();
  double commanded_tilt_rad() const;

  Params params_;
  std::optional<TiltFilter> filter_ = {};
  bool tilt_known_ = false, wheels_known_ = false, fallen_ = false;
  StampInterval tilt_interval_ = {};
  double tilt_rad_ = 0, rate_radps_ = 0;
  double left_radps_ = 0, right_radps_ = 0;  // of the wheels relative to the body
  double speed_mps_ = 0, turn_radps_ = 0;
  double asked_mps_ = 0, asked_turn_radps_ = 0;
  std::optional<double> asked_tilt_rad_ = {};
  bool was_tilted_ = false;
  double acceleration_mps2_ = 0;
  double desired_mps_ = 0;  // follows the command with limited acceleration
  double distance_m_ = 0;   // integral of the error of the speed
  double turned_rad_ = 0;   // integral of the error of the turn rate
};

}  // namespace autonomy
