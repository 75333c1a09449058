#pragma once

#include <string>
#include <vector>

#include "devices/wheel_motors.hpp"

namespace devices {

/// Wheels on the left that turn at one speed and wheels on the right that turn at another.  Ground speed of a side:
/// radius * rate; turn rate: (right - left) / track.
class TwoSidedDrive : public sim::Actuator {
 public:
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::coast};
  /// What both kinds of drive have; each reads its joints itself.
  struct Params {
    double wheel_radius_m = 0.1;
    double track_m = 0.4;
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
  /// Where a side cannot turn as fast as asked, both are slowed so that the curvature stays.
  void set_twist(double forward_mps, double turn_radps);
  /// As a vessel: thrust sets the forward speed, the rudder a turn rate in proportion to it.
  void set_thrust_rudder(double thrust, double rudder);

 protected:
  TwoSidedDrive(const Params& params, const sim::DeviceContext& context, const std::vector<std::string>& left_joints,
                const std::vector<std::string>& right_joints);
  /// A command that is too fast now is slowed, with its curvature.
  void change_drive(const Params& params);

 private:
  Params params_;
  WheelMotors left_;
  WheelMotors right_;
  bool coasting_ = false;
};

}  // namespace devices
