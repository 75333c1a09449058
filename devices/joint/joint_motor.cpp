// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/joint_motor.hpp"

#include <algorithm>

#include "devices/joint/joint_of_device.hpp"
#include "shoal/joint_command_t.hpp"
#include "shoal/message_codec.hpp"

namespace devices {

void JointMotor::Params::read(sim::ParamReader& in) {
  in.require("joint");
  in.read_reference("joint", joint, "joint", "hinge or slider that it drives");
  in.read("max_velocity", max_velocity, sim::above(0), "maximum command, rad/s or m/s");
  in.read("max_force", max_force, sim::above(0), "maximum effort, N m or N");
  power.read(in);
}

JointMotor::JointMotor(const Params& params, const sim::DeviceContext& context)
    : params_(params), joint_(joint_with_axis(context, params.joint, 0)), vehicle_(context.vehicle) {}

void JointMotor::act(const sim::ActContext& context) {
  if (vehicle_.systems().metered) joint_.measure_load();
  joint_.set_motor(velocity_, coasting_ ? 0 : context.effectiveness * params_.max_force);
}

void JointMotor::make_safe(sim::SafeState safe) {
  velocity_ = 0;
  coasting_ = safe == sim::SafeState::coast;
}

void JointMotor::change(const Params& params) {
  params_ = params;
  velocity_ = std::clamp(velocity_, -params_.max_velocity, params_.max_velocity);
}

void JointMotor::set_velocity(double velocity) {
  coasting_ = false;
  velocity_ = std::clamp(velocity, -params_.max_velocity, params_.max_velocity);
}

void JointMotorController::receive(sim::Time, std::span<const std::byte> payload) {
  motor_.set_velocity(shoal::decode<shoal::joint_command_t>(payload, shoal::Finite::required).velocity);
}

SHOAL_ACTUATOR("joint_motor", JointMotor, JointMotorController);

}  // namespace devices
