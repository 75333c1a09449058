// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/drive/wheel_motors.hpp"

namespace devices {

/// Drive with one speed for the wheels on the left and another for those on the right.  Ground speed of a side:
/// radius * rate; turn rate: (right - left) / track.
class TwoSidedDrive : public sim::Actuator {
 public:
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::coast};
  /// Parameters of both kinds of drive; each reads its joints itself.
  struct Params {
    std::optional<double> wheel_radius_m;  ///< unset: radius of the wheels
    std::optional<double> track_m;         ///< unset: distance between the wheels
    double max_speed_mps = 1.0;
    double max_turn_radps = 2.0;
    double max_acceleration_mps2 = 2.0;  ///< acceleration of the ground speed of a wheel
    double max_torque_Nm = 10.0;         ///< torque of each motor
    MotorPower power;
    void read(sim::ParamReader& in, const char* meaning_of_track);
  };

  void act(const sim::ActContext& context) override;
  /// Applies a safe state.  stop: the wheels brake; coast: they turn freely.
  void make_safe(sim::SafeState safe) override;
  double power_W() const override;
  void visit_state(sim::StateArchive& archive) override;

  void set_wheel_speeds(double left_radps, double right_radps);
  /// Commands a twist.  When a side cannot reach its speed, both are slowed so that the curvature is kept.
  void set_twist(double forward_mps, double turn_radps);
  /// Commands thrust, which sets the forward speed, and rudder, which sets a turn rate in proportion to it, as on a
  /// vessel.
  void set_thrust_rudder(double thrust, double rudder);
  double track_m() const { return track_m_; }
  double wheel_radius_m() const { return wheel_radius_m_; }

 protected:
  /// `scrubs`: skid steering, with an effective track wider than the distance between the wheels.
  TwoSidedDrive(const Params& params, const sim::DeviceContext& context, const std::vector<std::string>& left_joints,
                const std::vector<std::string>& right_joints, bool scrubs = false);
  /// Applies changed parameters.  A command above the new limits is slowed with its curvature kept.
  void change_drive(const Params& params);

 private:
  void take_lengths();
  void check_lengths(const sim::DeviceContext& context, bool scrubs) const;

  Params params_;
  double joint_track_m_ = 0;              ///< track from the joints
  double usual_track_m_ = 0;              ///< default track
  std::optional<double> joint_radius_m_;  ///< radius of the wheels of the joints
  double wheel_radius_m_ = 0, track_m_ = 0;
  WheelMotors left_;
  WheelMotors right_;
  bool coasting_ = false;
};

}  // namespace devices
