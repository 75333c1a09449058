// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/two_sided_drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "devices/drive/wheel_geometry.hpp"
#include "devices/drive/wheel_sides.hpp"
#include "devices/joint/joint_of_device.hpp"

namespace devices {

namespace {

/// Default radius of wheels without one in their shape, such as meshes.
constexpr double usual_wheel_radius_m = 0.1;

}  // namespace

void TwoSidedDrive::Params::read(sim::ParamReader& in, const char* meaning_of_track) {
  in.read("wheel_radius_m", wheel_radius_m, sim::above(0), "radius of the driven wheels; unset: as in the vehicle");
  in.read("track_m", track_m, sim::above(0), meaning_of_track);
  in.read("max_speed_mps", max_speed_mps, sim::above(0), "ground speed a wheel can reach");
  in.read("max_turn_radps", max_turn_radps, sim::above(0), "maximum turn rate");
  in.read("max_acceleration_mps2", max_acceleration_mps2, sim::above(0),
          "maximum acceleration of a wheel's ground speed");
  in.read("max_torque_Nm", max_torque_Nm, sim::above(0), "maximum torque of each motor");
  power.read(in);
}

TwoSidedDrive::TwoSidedDrive(const Params& params, const sim::DeviceContext& context,
                             const std::vector<std::string>& left_joints, const std::vector<std::string>& right_joints,
                             bool scrubs)
    : params_(params), left_(context, left_joints), right_(context, right_joints) {
  const sim::VehicleConfig& vehicle = context.vehicle.config();
  joint_track_m_ = track_m_of(vehicle, left_joints, right_joints);
  // Wheels that scrub turn a vehicle as if they were farther apart than they are.
  usual_track_m_ = scrubs ? scrubbing_track_m_of(vehicle, left_joints, right_joints) : joint_track_m_;
  std::vector<std::string> joints = left_joints;
  joints.insert(joints.end(), right_joints.begin(), right_joints.end());
  joint_radius_m_ = wheel_radius_m_of(vehicle, joints);
  if (!params.track_m && !(joint_track_m_ > 0)) refuse(context, "'track_m' is needed: its wheels are in one place");
  take_lengths();
  check_lengths(context, scrubs);
  warn_of_sides(context, {scrubs ? "left_joints" : "left_joint", left_joints},
                {scrubs ? "right_joints" : "right_joint", right_joints});
  warn_of_shared_weight(context, joints);
}

/// Sets the lengths: configured ones first, then those of the joints and wheels.
void TwoSidedDrive::take_lengths() {
  track_m_ = params_.track_m.value_or(usual_track_m_);
  wheel_radius_m_ = params_.wheel_radius_m.value_or(joint_radius_m_.value_or(usual_wheel_radius_m));
}

void TwoSidedDrive::check_lengths(const sim::DeviceContext& context, bool scrubs) const {
  const AllowedRatio usual;
  const AllowedRatio at_least{usual.low, std::numeric_limits<double>::infinity()};
  check_length(context, {"track_m", params_.track_m, joint_track_m_}, scrubs ? at_least : usual,
               scrubs ? "it turns slower than commanded" : "it turns {} times as fast as commanded", as_it_is);
  check_length(context, {"wheel_radius_m", params_.wheel_radius_m, joint_radius_m_}, usual,
               "it drives {} times as fast as commanded", inverse);
}

void TwoSidedDrive::act(const sim::ActContext& context) {
  const double acceleration_radps2 = params_.max_acceleration_mps2 / wheel_radius_m_;
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
  take_lengths();
  const double max = params_.max_speed_mps / wheel_radius_m_;
  const double fastest = std::max(std::abs(left_.target_radps()), std::abs(right_.target_radps()));
  if (fastest <= max) return;
  for (WheelMotors* side : {&left_, &right_}) side->set_target(side->target_radps() * max / fastest);
}

void TwoSidedDrive::set_wheel_speeds(double left_radps, double right_radps) {
  coasting_ = false;
  const double max = params_.max_speed_mps / wheel_radius_m_;
  left_.set_target(std::clamp(left_radps, -max, max));
  right_.set_target(std::clamp(right_radps, -max, max));
}

void TwoSidedDrive::set_twist(double forward_mps, double turn_radps) {
  turn_radps = std::clamp(turn_radps, -params_.max_turn_radps, params_.max_turn_radps);
  const double half_difference = 0.5 * track_m_ * turn_radps;
  const double fastest = std::abs(forward_mps) + std::abs(half_difference);
  const double scale = fastest > params_.max_speed_mps ? params_.max_speed_mps / fastest : 1.0;
  set_wheel_speeds(scale * (forward_mps - half_difference) / wheel_radius_m_,
                   scale * (forward_mps + half_difference) / wheel_radius_m_);
}

void TwoSidedDrive::set_thrust_rudder(double thrust, double rudder) {
  thrust = std::clamp(thrust, -1.0, 1.0);
  rudder = std::clamp(rudder, -1.0, 1.0);
  set_twist(thrust * params_.max_speed_mps, thrust * rudder * params_.max_turn_radps);
}

}  // namespace devices
