#include "devices/differential_drive.hpp"

#include <algorithm>
#include <cmath>

#include "shoal/message_codec.hpp"
#include "shoal/thrust_rudder_command_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/wheel_speeds_command_t.hpp"

namespace devices {

void DifferentialDrive::Params::read(sim::ParamReader& in) {
  in.require("left_joint");
  in.read_reference("left_joint", left_joint, "joint", "hinge of the left wheel, axis to the left");
  in.require("right_joint");
  in.read_reference("right_joint", right_joint, "joint", "hinge of the right wheel, axis to the left");
  in.read("wheel_radius_m", wheel_radius_m, sim::above(0), "radius of both wheels");
  in.read("track_m", track_m, sim::above(0), "distance between the wheels");
  in.read("max_speed_mps", max_speed_mps, sim::above(0), "ground speed a wheel can reach");
  in.read("max_turn_radps", max_turn_radps, sim::above(0), "turn rates are cut to this");
  in.read("max_acceleration_mps2", max_acceleration_mps2, sim::above(0), "of a wheel's ground speed");
  in.read("max_torque_Nm", max_torque_Nm, sim::above(0), "the most each motor can give");
}

DifferentialDrive::DifferentialDrive(const Params& params, const sim::DeviceContext& context)
    : params_(params), left_(context.joint(params.left_joint)), right_(context.joint(params.right_joint)) {}

void DifferentialDrive::act(const sim::ActContext& context) {
  const double change = params_.max_acceleration_mps2 / params_.wheel_radius_m * context.step_s;
  for (int side = 0; side < 2; ++side)
    current_radps_[side] += std::clamp(target_radps_[side] - current_radps_[side], -change, change);
  const double torque_Nm = coasting_ ? 0 : context.effectiveness * params_.max_torque_Nm;
  left_.set_motor(current_radps_[0], torque_Nm);
  right_.set_motor(current_radps_[1], torque_Nm);
}

void DifferentialDrive::make_safe(sim::SafeState safe) {
  set_wheel_speeds(0, 0);
  coasting_ = safe == sim::SafeState::coast;
}

void DifferentialDrive::hash_state(sim::StateHash& hash) const {
  hash.add(std::span<const double>(target_radps_));
  hash.add(std::span<const double>(current_radps_));
  hash.add(coasting_);
}

void DifferentialDrive::set_wheel_speeds(double left_radps, double right_radps) {
  coasting_ = false;
  const double most = params_.max_speed_mps / params_.wheel_radius_m;
  target_radps_[0] = std::clamp(left_radps, -most, most);
  target_radps_[1] = std::clamp(right_radps, -most, most);
}

void DifferentialDrive::set_twist(double forward_mps, double turn_radps) {
  turn_radps = std::clamp(turn_radps, -params_.max_turn_radps, params_.max_turn_radps);
  const double half_difference = 0.5 * params_.track_m * turn_radps;
  const double fastest = std::abs(forward_mps) + std::abs(half_difference);
  const double scale = fastest > params_.max_speed_mps ? params_.max_speed_mps / fastest : 1.0;
  set_wheel_speeds(scale * (forward_mps - half_difference) / params_.wheel_radius_m,
                   scale * (forward_mps + half_difference) / params_.wheel_radius_m);
}

void DifferentialDrive::set_thrust_rudder(double thrust, double rudder) {
  thrust = std::clamp(thrust, -1.0, 1.0);
  rudder = std::clamp(rudder, -1.0, 1.0);
  set_twist(thrust * params_.max_speed_mps, thrust * rudder * params_.max_turn_radps);
}

void DifferentialDriveController::receive(sim::Time, std::span<const std::byte> payload) {
  using shoal::Finite;
  const std::int64_t type = shoal::fingerprint(payload);
  if (type == shoal::fingerprint_of<shoal::wheel_speeds_command_t>()) {
    const auto command = shoal::decode<shoal::wheel_speeds_command_t>(payload, Finite::required);
    drive_.set_wheel_speeds(command.left_radps, command.right_radps);
  } else if (type == shoal::fingerprint_of<shoal::thrust_rudder_command_t>()) {
    const auto command = shoal::decode<shoal::thrust_rudder_command_t>(payload, Finite::required);
    drive_.set_thrust_rudder(command.thrust, command.rudder);
  } else {
    const auto command = shoal::decode<shoal::twist_command_t>(payload, Finite::required);
    drive_.set_twist(command.forward_mps, command.turn_radps);
  }
}

SHOAL_ACTUATOR("differential_drive", DifferentialDrive, DifferentialDriveController);

}  // namespace devices
