#pragma once

#include "sim/device/device_registry.hpp"
#include "sim/physics/joint.hpp"

namespace devices {

/// Two driven wheels on one axle.  Ground speed of a wheel: radius * rate; turn rate: (right - left) / track.
class DifferentialDrive final : public sim::Actuator {
 public:
  static constexpr const char* meaning =
      "Two driven wheels, commanded by wheel speeds, by forward speed and turn rate, or by thrust and rudder.";
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::coast};
  struct Params {
    std::string left_joint;
    std::string right_joint;
    double wheel_radius_m = 0.1;
    double track_m = 0.4;
    double max_speed_mps = 1.0;
    double max_turn_radps = 2.0;
    double max_acceleration_mps2 = 2.0;  ///< of a wheel's ground speed
    double max_torque_Nm = 10.0;         ///< of each motor
    void read(sim::ParamReader& in);
  };

  DifferentialDrive(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context) override;
  /// stop: the wheels brake; coast: they turn freely.
  void make_safe(sim::SafeState safe) override;
  void change(const Params& params) { params_ = params; }
  void hash_state(sim::StateHash& hash) const override;

  void set_wheel_speeds(double left_radps, double right_radps);
  /// Where a wheel cannot turn as fast as asked, both are slowed so that the curvature stays.
  void set_twist(double forward_mps, double turn_radps);
  /// As a vessel: thrust sets the forward speed, the rudder a turn rate in proportion to it.
  void set_thrust_rudder(double thrust, double rudder);

 private:
  Params params_;
  sim::Joint& left_;
  sim::Joint& right_;
  double target_radps_[2] = {0, 0};
  double current_radps_[2] = {0, 0};
  bool coasting_ = false;
};

/// Takes shoal.wheel_speeds_command_t, shoal.twist_command_t or shoal.thrust_rudder_command_t, told apart by their
/// fingerprints.
class DifferentialDriveController final : public sim::Controller {
 public:
  static constexpr const char* command_messages =
      "shoal.twist_command_t, shoal.wheel_speeds_command_t, shoal.thrust_rudder_command_t";
  explicit DifferentialDriveController(DifferentialDrive& drive) : drive_(drive) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  DifferentialDrive& drive_;
};

}  // namespace devices
