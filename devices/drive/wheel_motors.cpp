// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/wheel_motors.hpp"

#include <algorithm>

#include "devices/joint/joint_of_device.hpp"

namespace devices {

WheelMotors::WheelMotors(const sim::DeviceContext& context, const std::vector<std::string>& joints)
    : vehicle_(context.vehicle) {
  for (const std::string& name : joints) {
    sim::Joint& joint = wheel_joint(context, name);
    wheels_.push_back({&joint, joint.axes() - 1});
  }
}

void WheelMotors::act(double max_acceleration_radps2, double max_torque_Nm, double step_s) {
  const double change = max_acceleration_radps2 * step_s;
  current_radps_ += std::clamp(target_radps_ - current_radps_, -change, change);
  for (const Wheel& wheel : wheels_) {
    if (vehicle_.systems().metered) wheel.joint->measure_load();
    wheel.joint->set_motor(current_radps_, max_torque_Nm, wheel.axis);
  }
}

double WheelMotors::power_W(const MotorPower& power, double max_torque_Nm) const {
  double sum_W = 0;
  for (const Wheel& wheel : wheels_) sum_W += power.of_motor(*wheel.joint, wheel.axis, max_torque_Nm);
  return sum_W;
}

}  // namespace devices
