// SPDX-License-Identifier: BSD-3-Clause
#include "devices/motion/servo_bank.hpp"

#include <algorithm>
#include <limits>

#include "devices/joint/joint_of_device.hpp"
#include "sim/config/message_text.hpp"

namespace devices {

namespace {

ServoOfVehicle servo_of(const sim::VehicleConfig& vehicle, const std::string& device,
                        const JointServo::Params& params) {
  constexpr double no_limit = std::numeric_limits<double>::infinity();
  ServoOfVehicle servo{device, &params, params.low.value_or(-no_limit), params.high.value_or(no_limit)};
  for (const sim::JointConfig& joint : vehicle.joints) {
    if (joint.name != params.joint) continue;
    const sim::JointAxisConfig& axis = params.axis == 0 ? joint.axis1 : joint.axis2;
    servo.low = std::max(servo.low, axis.low_stop.value_or(-no_limit));
    servo.high = std::min(servo.high, axis.high_stop.value_or(no_limit));
  }
  return servo;
}

}  // namespace

bool ServoOfVehicle::is_called(const std::string& name) const {
  return device == name || (!params->alias.empty() && params->alias == name);
}

std::vector<ServoOfVehicle> servos_of(const sim::VehicleConfig& vehicle) {
  std::vector<ServoOfVehicle> servos;
  for (const sim::DeviceConfig& device : vehicle.devices)
    if (const auto* params = dynamic_cast<const sim::detail::ParamsOf<JointServo::Params>*>(device.params.get()))
      servos.push_back(servo_of(vehicle, device.name, params->params));
  return servos;
}

ServoBank::ServoBank(const sim::DeviceContext& context, const std::vector<std::string>& names)
    : vehicle_(context.vehicle) {
  std::vector<Member> all;
  std::vector<std::string> known;
  for (const ServoOfVehicle& servo : servos_of(context.vehicle.config())) {
    all.push_back({servo.device, servo.params->alias});
    known.push_back(servo.device);
  }
  if (all.empty()) refuse(context, "the vehicle has no joint_servo");
  if (names.empty()) {
    members_ = std::move(all);
    return;
  }
  for (const std::string& name : names) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Member& one) {
      return one.name == name || (!one.alias.empty() && one.alias == name);
    });
    const std::string shown = "'joints' names '" + sim::shortened(sim::printable(name)) + "'";
    if (found == all.end())
      refuse(context, shown + ", which is not a joint_servo of the vehicle" + sim::did_you_mean(name, known) +
                          "; known: " + sim::list_text(known));
    // One servo twice would get two set points in each frame.
    if (find(found->name)) refuse(context, shown + " twice");
    members_.push_back(*found);
  }
}

std::optional<std::size_t> ServoBank::find(const std::string& name_or_alias) const {
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (members_[i].name == name_or_alias || (!members_[i].alias.empty() && members_[i].alias == name_or_alias))
      return i;
  return std::nullopt;
}

std::vector<std::string> ServoBank::names() const {
  std::vector<std::string> names;
  for (const Member& one : members_) names.push_back(one.name);
  return names;
}

ServoBank::Member& ServoBank::member(std::size_t i) {
  Member& one = members_[i];
  if (one.servo == nullptr) {
    one.acting = vehicle_.find_device(one.name)->acting();
    one.servo = static_cast<JointServo*>(one.acting->actuator);
  }
  return one;
}

void ServoBank::command(std::size_t i, double position, sim::Time now) {
  Member& one = member(i);
  if (one.acting->take_command(now)) one.servo->set_position(position);
}

double ServoBank::set_point(std::size_t i) {
  return member(i).servo->set_point().position;
}

double ServoBank::position(std::size_t i) {
  return member(i).servo->joint_position();
}

double ServoBank::low(std::size_t i) {
  return member(i).servo->low();
}

double ServoBank::high(std::size_t i) {
  return member(i).servo->high();
}

}  // namespace devices
