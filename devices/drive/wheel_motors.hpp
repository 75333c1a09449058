// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "devices/joint/joint_power.hpp"
#include "sim/physics/joint.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

/// Driven wheels with a common speed, each with its own motor.  The speed follows its target with limited acceleration.
class WheelMotors {
 public:
  WheelMotors(const sim::DeviceContext& context, const std::vector<std::string>& joints);

  void set_target(double radps) { target_radps_ = radps; }
  /// Runs one step.  `max_torque_Nm`: maximum torque of each motor; 0: the wheels turn freely.
  void act(double max_acceleration_radps2, double max_torque_Nm, double step_s);
  double target_radps() const { return target_radps_; }
  double current_radps() const { return current_radps_; }
  double power_W(const MotorPower& power, double max_torque_Nm) const;
  void visit_state(sim::StateArchive& archive) { archive(target_radps_, current_radps_); }

 private:
  struct Wheel {
    sim::Joint* joint;
    int axis;  ///< last axis of the joint; the wheel axis of a hinge2
  };
  const sim::Vehicle& vehicle_;
  std::vector<Wheel> wheels_;
  double target_radps_ = 0;
  double current_radps_ = 0;
};

}  // namespace devices
