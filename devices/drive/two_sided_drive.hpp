// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/drive/wheel_motors.hpp"

namespace devices {

/// Wheels on the left that turn at one speed and wheels on the right that turn at another.  Ground speed of a side:
/// radius * rate; turn rate: (right - left) / track.
class TwoSidedDrive : public sim::Actuator {
 public:
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::coast};
  /// What both kinds of drive have; each reads its joints itself.
  struct Params {
    std::optional<double> wheel_radius_m;  ///< unset: that of the wheels
    std::optional<double> track_m;         ///< unset: the distance of the wheels
    double max_speed_mps = 1.0;
    double max_turn_radps = 2.0;
    double max_acceleration_mps2 = 2.0;  ///< of a wheel's ground speed
    double max_torque_Nm = 10.0;         ///< of each motor
    MotorPower power;
    void read(sim::ParamReader& in, const char* meaning_of_track);
  };

  void act(const sim::ActContext& context) override;
  /// stop: the wheels brake; coast: they turn freely.
  void make_safe(sim::SafeState safe) override;
  double power_W() const override;
  void visit_state(sim::StateArchive& archive) override;

  void set_wheel_speeds(double left_radps, double right_radps);
  /// Where a side cannot turn as fast as commanded, both are slowed so that the curvature is kept.
  void set_twist(double forward_mps, double turn_radps);
  /// As a vessel: thrust sets the forward speed, the rudder a turn rate in proportion to it.
  void set_thrust_rudder(double thrust, double rudder);
  double track_m() const { return track_m_; }
  double wheel_radius_m() const { return wheel_radius_m_; }

 protected:
  /// `scrubs`: it turns by slip, with a track that is wider than its wheels are apart.
  TwoSidedDrive(const Params& params, const sim::DeviceContext& context, const std::vector<std::string>& left_joints,
                const std::vector<std::string>& right_joints, bool scrubs = false);
  /// A command that is too fast now is slowed, with its curvature.
  void change_drive(const Params& params);

 private:
  void take_lengths();
  void check_lengths(const sim::DeviceContext& context, bool scrubs) const;

  Params params_;
  double joint_track_m_ = 0;              ///< as the joints have it
  double usual_track_m_ = 0;              ///< where none is given
  std::optional<double> joint_radius_m_;  ///< of their wheels
  double wheel_radius_m_ = 0, track_m_ = 0;
  WheelMotors left_;
  WheelMotors right_;
  bool coasting_ = false;
};

}  // namespace devices
