// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/ackermann_drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "devices/drive/drive_commands.hpp"
#include "devices/drive/wheel_geometry.hpp"
#include "devices/drive/wheel_sides.hpp"
#include "devices/joint/joint_of_device.hpp"
#include "sim/config/message_text.hpp"

namespace devices {

namespace {

constexpr const char* turns_inside_text = "at 'max_steering_deg' the center of turn must lie outside the track";

bool turns_inside(double track_m, double wheelbase_m, double max_steering_rad) {
  return track_m / 2 * std::tan(max_steering_rad) >= wheelbase_m;
}

}  // namespace

void AckermannDrive::Params::read(sim::ParamReader& in) {
  // Joints.
  in.require("left_steer_joint");
  in.read_reference("left_steer_joint", left_steer_joint, "joint", "steers the left front wheel; first axis up");
  in.require("right_steer_joint");
  in.read_reference("right_steer_joint", right_steer_joint, "joint", "steers the right front wheel; first axis up");
  in.require("drive_joints");
  in.read_references("drive_joints", drive_joints, "joint", "joints of the driven wheels, axes to the left");
  if (in.has("drive_joints") && drive_joints.empty()) in.error("drive_joints", "'drive_joints' must name a joint");
  // Geometry.
  in.read("wheelbase_m", wheelbase_m, sim::above(0), "distance from rear to front axle; unset: taken from the wheels");
  in.read("track_m", track_m, sim::above(0),
          "between the axes that the front wheels are steered about; unset: as the joints are");
  in.read("wheel_radius_m", wheel_radius_m, sim::above(0), "radius of the driven wheels; unset: as in the vehicle");
  in.read("differential", differential,
          "each driven wheel turns at the speed of its own path; false: all at the same speed");
  // Limits.
  in.read("max_speed_mps", max_speed_mps, sim::above(0), "maximum speed");
  in.read("max_acceleration_mps2", max_acceleration_mps2, sim::above(0), "maximum acceleration of the speed");
  in.read("max_torque_Nm", max_torque_Nm, sim::above(0), "maximum torque of the motor of each driven wheel");
  in.read_deg("max_steering_deg", max_steering_rad, sim::above_to(0, 80), "maximum steering angle");
  in.read("max_steering_rate_radps", max_steering_rate_radps, sim::above(0), "maximum rate of the steering angle");
  in.read("max_steering_torque_Nm", max_steering_torque_Nm, sim::above(0), "maximum torque of each steering motor");
  power.read(in);
  if (track_m && wheelbase_m && turns_inside(*track_m, *wheelbase_m, max_steering_rad))
    in.error("max_steering_deg", turns_inside_text);
}

AckermannDrive::AckermannDrive(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      vehicle_(context.vehicle),
      steer_{&wheel_joint(context, params.left_steer_joint), &wheel_joint(context, params.right_steer_joint)} {
  // Places of the wheels count from the middle of the front axle, about which Ackermann's condition is written.
  const sim::Vector3d front_V = (joint_config(vehicle_, params.left_steer_joint).anchor_m +
                                 joint_config(vehicle_, params.right_steer_joint).anchor_m) /
                                2;
  for (const std::string& name : params.drive_joints) {
    const sim::Vector3d p_m = joint_config(vehicle_, name).anchor_m - front_V;
    wheels_.push_back({WheelMotors(context, {name}), p_m.x(), p_m.y()});
  }
  take_lengths(context);
  warn_of_backward_wheels(context, params.drive_joints);
  warn_of_backward_steering(context, {params.left_steer_joint, params.right_steer_joint});
  warn_of_swapped_sides(context, {"left_steer_joint", {params.left_steer_joint}},
                        {"right_steer_joint", {params.right_steer_joint}});
  warn_of_shared_weight(context, params.drive_joints);
}

void AckermannDrive::take_lengths(const sim::DeviceContext& context) {
  const sim::VehicleConfig& vehicle = vehicle_.config();
  const std::vector<std::string> steered = {params_.left_steer_joint, params_.right_steer_joint};
  const sim::Vector3d across_m =
      joint_config(vehicle_, steered[0]).anchor_m - joint_config(vehicle_, steered[1]).anchor_m;
  const std::optional<double> track_m = across_m.norm() > 0 ? std::optional(across_m.norm()) : std::nullopt;
  const std::optional<double> wheelbase_m = wheelbase_m_of(vehicle, steered);
  const std::optional<double> radius_m = wheel_radius_m_of(vehicle, params_.drive_joints);
  check_length(context, {"track_m", params_.track_m, track_m}, {},
               "the axes of its front wheels do not meet in one center of turn", as_it_is);
  check_length(context, {"wheelbase_m", params_.wheelbase_m, wheelbase_m}, {}, "it turns {} times as fast as commanded",
               as_it_is);
  check_length(context, {"wheel_radius_m", params_.wheel_radius_m, radius_m}, {},
               "it drives {} times as fast as commanded", inverse);
  // A length that is configured differently from the joints is legal: it makes the errors of a badly
  // calibrated drive. The warning says how large they are.
  of_joints_ = {wheelbase_m.value_or(of_joints_.wheelbase_m), track_m.value_or(of_joints_.track_m),
                radius_m.value_or(of_joints_.wheel_radius_m)};
  lengths_ = lengths_of(params_);
  if (turns_inside(lengths_.track_m, lengths_.wheelbase_m, params_.max_steering_rad))
    refuse(context, turns_inside_text);
  check_stops(context);
}

/// Warns when the stops of the steering joints are within the largest steering angle, that of the inner wheel in a
/// turn.
void AckermannDrive::check_stops(const sim::DeviceContext& context) const {
  const double tangent = std::tan(params_.max_steering_rad);
  const double L = lengths_.wheelbase_m;
  const double inner_rad = std::atan(L * tangent / (L - lengths_.track_m / 2 * tangent));
  const sim::JointAxisConfig& left = joint_config(vehicle_, params_.left_steer_joint).axis1;
  const sim::JointAxisConfig& right = joint_config(vehicle_, params_.right_steer_joint).axis1;
  for (const auto& [name, stop_rad] :
       {std::pair{params_.left_steer_joint, left.high_stop}, std::pair{params_.right_steer_joint, right.low_stop}}) {
    if (!stop_rad || inner_rad <= std::abs(*stop_rad) + 0.01) continue;
    const sim::DeviceConfig& config = context.config;
    context.host.warnings.building().warn(
        config.source ? sim::place_of(*config.source, "max_steering_deg") : config.place,
        "vehicle '" + vehicle_.name() + "': device '" + config.name + "'",
        "at 'max_steering_deg' it steers the inner wheel by " + sim::number_text(std::round(inner_rad * 1000) / 1000) +
            " rad, and joint '" + name + "' stops at " + sim::number_text(*stop_rad));
  }
}

AckermannDrive::Lengths AckermannDrive::lengths_of(const Params& params) const {
  return {params.wheelbase_m.value_or(of_joints_.wheelbase_m), params.track_m.value_or(of_joints_.track_m),
          params.wheel_radius_m.value_or(of_joints_.wheel_radius_m)};
}

void AckermannDrive::change(const Params& params) {
  params_ = params;
  lengths_ = lengths_of(params_);
  clamp_targets();
}

/// `side`: -1 left, 1 right.
void AckermannDrive::steer(sim::Joint& joint, double side, double torque_Nm, double step_s) {
  const double tangent = std::tan(steering_rad_);
  const double L = lengths_.wheelbase_m;
  const double angle_rad = std::atan(L * tangent / (L + side * lengths_.track_m / 2 * tangent));
  // Correct a fifth of the error per step, as with ERP 0.2 of ODE: fast and without overshoot.
  const double velocity = 0.2 * (angle_rad - joint.position(0)) / step_s;
  const double max =
      2 * params_.max_steering_rate_radps;  // the inner wheel steers faster than the virtual middle wheel
  if (vehicle_.systems().metered) joint.measure_load();
  joint.set_motor(std::clamp(velocity, -max, max), torque_Nm, 0);
}

double AckermannDrive::speed_ratio(const DrivenWheel& wheel) const {
  if (!params_.differential) return 1;
  const double curvature = std::tan(steering_rad_) / lengths_.wheelbase_m;
  // Velocity of the wheel position; a front wheel is aligned with it.
  return std::hypot(1 - curvature * wheel.y_m, curvature * (wheel.x_m + lengths_.wheelbase_m));
}

void AckermannDrive::act(const sim::ActContext& context) {
  const double effort = coasting_ ? 0 : context.effectiveness;
  const double speed_change = params_.max_acceleration_mps2 * context.step_s;
  speed_mps_ += std::clamp(target_mps_ - speed_mps_, -speed_change, speed_change);
  const double turn = params_.max_steering_rate_radps * context.step_s;
  steering_rad_ += std::clamp(target_steering_rad_ - steering_rad_, -turn, turn);
  steer(*steer_[0], -1, effort * params_.max_steering_torque_Nm, context.step_s);
  steer(*steer_[1], 1, effort * params_.max_steering_torque_Nm, context.step_s);
  for (DrivenWheel& wheel : wheels_) {
    wheel.motors.set_target(speed_mps_ * speed_ratio(wheel) / lengths_.wheel_radius_m);
    // The speed of the vehicle is limited above; the wheel follows without a further limit.
    wheel.motors.act(std::numeric_limits<double>::infinity(), effort * params_.max_torque_Nm, context.step_s);
  }
}

void AckermannDrive::make_safe(sim::SafeState safe) {
  target_mps_ = 0;
  coasting_ = safe == sim::SafeState::coast;
}

double AckermannDrive::power_W() const {
  double sum_W = 0;
  for (const sim::Joint* joint : steer_) sum_W += params_.power.of_motor(*joint, 0, params_.max_steering_torque_Nm);
  for (const DrivenWheel& wheel : wheels_) sum_W += wheel.motors.power_W(params_.power, params_.max_torque_Nm);
  return sum_W;
}

void AckermannDrive::visit_state(sim::StateArchive& archive) {
  archive(target_mps_, target_steering_rad_, speed_mps_, steering_rad_, coasting_);
  archive.expect_count(wheels_.size(), "driven wheels");
  for (DrivenWheel& wheel : wheels_) archive(wheel.motors);
}

void AckermannDrive::set_steering(double speed_mps, double steering_rad) {
  coasting_ = false;
  target_mps_ = speed_mps;
  target_steering_rad_ = steering_rad;
  clamp_targets();
}

void AckermannDrive::clamp_targets() {
  target_mps_ = std::clamp(target_mps_, -params_.max_speed_mps, params_.max_speed_mps);
  target_steering_rad_ = std::clamp(target_steering_rad_, -params_.max_steering_rad, params_.max_steering_rad);
}

void AckermannDrive::set_twist(double forward_mps, double turn_radps) {
  // Not atan2, which would reverse the steering in reverse motion.
  const double steering_rad = forward_mps == 0
                                  ? std::copysign(turn_radps == 0 ? 0.0 : params_.max_steering_rad, turn_radps)
                                  : std::atan(lengths_.wheelbase_m * turn_radps / forward_mps);
  set_steering(forward_mps, steering_rad);
}

void AckermannDrive::set_thrust_rudder(double thrust, double rudder) {
  set_steering(std::clamp(thrust, -1.0, 1.0) * params_.max_speed_mps,
               std::clamp(rudder, -1.0, 1.0) * params_.max_steering_rad);
}

void AckermannDriveController::receive(sim::Time, std::span<const std::byte> payload) {
  receive_drive_command(drive_, payload);
}

SHOAL_ACTUATOR("ackermann_drive", AckermannDrive, AckermannDriveController);

}  // namespace devices
