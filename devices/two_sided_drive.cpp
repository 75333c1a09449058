#include "devices/two_sided_drive.hpp"

#include <algorithm>
#include <cmath>

namespace devices {

void TwoSidedDrive::Params::read(sim::ParamReader& in, const char* meaning_of_track) {
  in.read("wheel_radius_m", wheel_radius_m, sim::above(0), "radius of the driven wheels");
  in.read("track_m", track_m, sim::above(0), meaning_of_track);
  in.read("max_speed_mps", max_speed_mps, sim::above(0), "ground speed a wheel can reach");
  in.read("max_turn_radps", max_turn_radps, sim::above(0), "turn rates are cut to this");
  in.read("max_acceleration_mps2", max_acceleration_mps2, sim::above(0), "of a wheel's ground speed");
  in.read("max_torque_Nm", max_torque_Nm, sim::above(0), "the most each motor can give");
  power.read(in);
}

TwoSidedDrive::TwoSidedDrive(const Params& params, const sim::DeviceContext& context,
                             const std::vector<std::string>& left_joints, const std::vector<std::string>& right_joints)
    : params_(params), left_(context, left_joints), right_(context, right_joints) {}

void TwoSidedDrive::act(const sim::ActContext& context) {
  const double acceleration_radps2 = params_.max_acceleration_mps2 / params_.wheel_radius_m;
  const double torque_Nm = coasting_ ? 0 : context.effectiveness * params_.max_torque_Nm;
  for (WheelMotors* side : {&left_, &right_}) side->act(acceleration_radps2, torque_Nm, context.step_s);
}

void TwoSidedDrive::make_safe(sim::SafeState safe) {
  set_wheel_speeds(0, 0);
  coasting_ = safe == sim::SafeState::coast;
}

double TwoSidedDrive::power_W() const {
  return left_.power_W(params_.power, params_.max_torque_Nm) + right_.power_W(params_.power, params_.max_torque_Nm);
}

void TwoSidedDrive::visit_state(sim::StateArchive& archive) {
  archive(left_, right_, coasting_);
}

void TwoSidedDrive::change_drive(const Params& params) {
  params_ = params;
  const double most = params_.max_speed_mps / params_.wheel_radius_m;
  const double fastest = std::max(std::abs(left_.target_radps()), std::abs(right_.target_radps()));
  if (fastest <= most) return;
  for (WheelMotors* side : {&left_, &right_}) side->set_target(side->target_radps() * most / fastest);
}

void TwoSidedDrive::set_wheel_speeds(double left_radps, double right_radps) {
  coasting_ = false;
  const double most = params_.max_speed_mps / params_.wheel_radius_m;
  left_.set_target(std::clamp(left_radps, -most, most));
  right_.set_target(std::clamp(right_radps, -most, most));
}

void TwoSidedDrive::set_twist(double forward_mps, double turn_radps) {
  turn_radps = std::clamp(turn_radps, -params_.max_turn_radps, params_.max_turn_radps);
  const double half_difference = 0.5 * params_.track_m * turn_radps;
  const double fastest = std::abs(forward_mps) + std::abs(half_difference);
  const double scale = fastest > params_.max_speed_mps ? params_.max_speed_mps / fastest : 1.0;
  set_wheel_speeds(scale * (forward_mps - half_difference) / params_.wheel_radius_m,
                   scale * (forward_mps + half_difference) / params_.wheel_radius_m);
}

void TwoSidedDrive::set_thrust_rudder(double thrust, double rudder) {
  thrust = std::clamp(thrust, -1.0, 1.0);
  rudder = std::clamp(rudder, -1.0, 1.0);
  set_twist(thrust * params_.max_speed_mps, thrust * rudder * params_.max_turn_radps);
}

}  // namespace devices
