// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/naive_drive.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shoal/helm_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/thrust_rudder_command_t.hpp"
#include "shoal/thrust_rudder_elevator_command_t.hpp"
#include "sim/config/message_text.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"

namespace devices {

void NaiveDrive::Params::read(sim::ParamReader& in) {
  in.read("max_speed_mps", max_speed_mps, sim::above_to(0, 100), "through the water, at full thrust");
  in.read("max_astern_mps", max_astern_mps, sim::between(0, 100), "at full thrust astern");
  in.read("speed_time_constant_s", speed_time_constant_s, sim::between(0, 1e4), "time constant of the speed");
  in.read_deg("max_turn_rate_degps", max_turn_rate_radps, sim::above_to(0, 360), "at full rudder");
  in.read("turn_time_constant_s", turn_time_constant_s, sim::between(0, 1e4), "time constant of the turn rate");
  in.read("steerage_speed_mps", steerage_speed_mps, sim::between(0, 100),
          "below this speed the rudder loses effect in proportion to the speed; 0: it turns on the spot");
  in.read_deg("max_pitch_deg", max_pitch_rad, sim::between(0, 80), "steepest path down or up");
  in.read("heading_gain_per_s", heading_gain_per_s, sim::above_to(0, 100), "turn rate by error of the heading");
  in.read("depth_gain_per_s", depth_gain_per_s, sim::above_to(0, 100), "speed down by error of the depth");
  constexpr double max =
      4;  // above it the oscillation is poorly damped: damping ratio 1 / (2 sqrt(gain * time constant))
  if (!in.describing() && heading_gain_per_s * turn_time_constant_s > max)
    in.error("heading_gain_per_s", "'heading_gain_per_s' times 'turn_time_constant_s' must be <= 4, got " +
                                       sim::number_text(heading_gain_per_s * turn_time_constant_s));
  in.read("rise_mps", rise_mps, sim::between(0, 100),
          "speed of rising when no depth is commanded, by positive buoyancy");
  in.read("surface", surface, "surface craft: it stays at the surface and accepts no depth");
  in.read("drifts", drifts, "whether the current carries it along");
  in.read("start_speed_mps", start_speed_mps, sim::between(-100, 100), "initial speed, kept until the first command");
}

NaiveDrive::NaiveDrive(const Params& params, const sim::DeviceContext& context)
    : body_(context.body),
      world_(context.world),
      warnings_(context.host.warnings),
      still_surface_m_(world_.config().medium.water ? world_.config().medium.water->surface_m : 0),
      speed_mps_(params.start_speed_mps),
      speed_target_mps_(params.start_speed_mps) {
  if (!body_.kinematic())
    sim::throw_config_error(context.config.place, "device '" + context.full_name() + "'",
                            "its body must have 'kinematic: true'");
  const auto& bodies = context.vehicle.config().bodies;
  const auto body_of = [&](const sim::DeviceConfig& device) {
    return device.body.empty() ? bodies.front().name : device.body;
  };
  // Two drives of one body would set its pose alternately.
  for (const sim::DeviceConfig& device : context.vehicle.config().devices)
    if (device.type == "naive_drive" && device.name != context.config.name &&
        body_of(device) == body_of(context.config))
      sim::throw_config_error(context.config.place, "device '" + context.full_name() + "'",
                              "its body is already moved by device '" + device.name + "'");
  change(params);
  take_pose();
}

void NaiveDrive::change(const Params& params) {
  params_ = params;
  max_sine_ = std::sin(params_.max_pitch_rad);
  step_s_ = 0;  // recompute the shares
}

/// Continues from the present pose when the body was moved by something else.
void NaiveDrive::take_pose() {
  X_WB_ = body_.X_WB();
  p_WB_ = X_WB_.translation();
  yaw_rad_ = sim::yaw_of(X_WB_.linear());
  pitch_rad_ = std::asin(std::clamp(X_WB_.linear()(2, 0), -1.0, 1.0));
}

/// Warns once when the vehicle has left the area of a current from a file.
void NaiveDrive::check_current() {
  if (!params_.drifts || left_the_current_ || world_.medium().current_known(p_WB_)) return;
  left_the_current_ = true;
  warnings_.warn("body '" + body_.name() + "'",
                 fmt::format("has left the file of the current at {:.1f}, {:.1f} m", p_WB_.x(), p_WB_.y()));
}

double NaiveDrive::desired_turn(double speed_share) const {
  const double max = params_.max_turn_rate_radps * std::min(1.0, std::abs(speed_share));
  if (std::isnan(heading_target_rad_))
    return rudder_ * params_.max_turn_rate_radps * std::clamp(speed_share, -1.0, 1.0);
  const double error = sim::wrap_angle(heading_target_rad_ - yaw_rad_);
  // No faster than the rate that reaches the heading in one step.
  const double gain = std::min(params_.heading_gain_per_s, 1 / step_s_);
  return std::clamp(gain * error, -max, max);
}

/// Returns the height of the instantaneous surface; zero in a world without water.
double NaiveDrive::surface_over_m() const {
  return world_.medium().has_water() ? world_.medium().surface_m(p_WB_.x(), p_WB_.y()) : still_surface_m_;
}

/// Returns the desired upward speed.  `surface_m`: height of the instantaneous surface.
double NaiveDrive::desired_climb(double surface_m) const {
  const double z_m = p_WB_.z(), max = std::abs(speed_mps_) * max_sine_;
  // Reduce the rise speed near the surface.
  const double level = params_.depth_gain_per_s * std::max(0.0, surface_m - z_m);
  if (std::isnan(depth_target_m_)) {
    const double climb = std::min(params_.rise_mps, level) - elevator_ * max;
    return world_.medium().has_water() ? std::min(climb, level) : climb;
  }
  const double climb = params_.depth_gain_per_s * (still_surface_m_ - depth_target_m_ - z_m);
  return std::clamp(world_.medium().has_water() ? std::min(climb, level) : climb, -max, max);
}

/// Returns the path commanded by depth or elevator.
NaiveDrive::Path NaiveDrive::path(double surface_m) {
  Path path{speed_mps_, 0, 0};
  if (params_.surface) return path;
  path.climb_mps = climb_mps_ = desired_climb(surface_m);
  if (std::abs(speed_mps_) > 1e-3) {
    const double sine = std::clamp(climb_mps_ / speed_mps_, -1.0, 1.0);
    path.pitch_rad = std::asin(std::clamp(sine, -max_sine_, max_sine_));
    path.forward_mps = speed_mps_ * std::sqrt(1 - sine * sine);
  }
  return path;
}

[[gnu::flatten]] void NaiveDrive::act(const sim::ActContext& context) {
  const double h = context.step_s;
  // Compute the response of a step.
  if (h != step_s_) {
    step_s_ = h;
    const auto share = [h](double time_constant_s) {
      return time_constant_s > 0 ? 1 - std::exp(-h / time_constant_s) : 1;
    };
    speed_share_ = share(params_.speed_time_constant_s);
    turn_share_ = share(params_.turn_time_constant_s);
  }
  constexpr double moved = 1e-6;
  if ((body_.p_WB() - p_WB_).squaredNorm() > moved * moved) take_pose();

  check_current();
  const sim::Medium& medium = world_.medium();
  // Advance speed, turn rate and yaw.
  speed_mps_ += (speed_target_mps_ * context.effectiveness - speed_mps_) * speed_share_;
  constexpr double astern_mps = 0.01;  // slower it turns on the spot
  const double speed_share = params_.steerage_speed_mps > 0 ? speed_mps_ / params_.steerage_speed_mps
                             : speed_mps_ < -astern_mps     ? -1
                                                            : 1;
  turn_radps_ += (desired_turn(speed_share) - turn_radps_) * turn_share_;
  yaw_rad_ = sim::wrap_angle(yaw_rad_ + h * turn_radps_);

  // Add the current and the velocity through the water.
  sim::Vector3d v_W = params_.drifts ? medium.water_velocity_W(p_WB_) : sim::Vector3d(sim::Vector3d::Zero());
  if (params_.surface) v_W.z() = 0;
  const double surface_m = params_.surface ? 0 : surface_over_m();
  const auto [forward_mps, climb_mps, pitch_rad] = path(surface_m);
  yaw_.turn_to(yaw_rad_);
  const double cos_yaw = yaw_.cosine, sin_yaw = yaw_.sine;
  v_W += sim::Vector3d(forward_mps * cos_yaw, forward_mps * sin_yaw, climb_mps);
  // Integrate the position, limited by the surface.
  const double z_before_m = p_WB_.z();
  p_WB_ += h * v_W;
  if (medium.has_water() && (params_.surface || p_WB_.z() > surface_m)) {
    p_WB_.z() = params_.surface ? surface_over_m() : surface_m;
    v_W.z() = (p_WB_.z() - z_before_m) / h;
  }
  // Rotation Rz(yaw) Ry(-pitch).
  pitch_.turn_to(pitch_rad);
  const double cos_pitch = pitch_.cosine, sin_pitch = pitch_.sine;
  X_WB_.linear() << cos_yaw * cos_pitch, -sin_yaw, -cos_yaw * sin_pitch,  //
      sin_yaw * cos_pitch, cos_yaw, -sin_yaw * sin_pitch,                 //
      sin_pitch, 0, cos_pitch;
  X_WB_.translation() = p_WB_;
  // Move the body, with its velocities.
  const double pitch_rate = (pitch_rad - pitch_rad_) / h;  // nose up, about -y
  pitch_rad_ = pitch_rad;
  body_.move_to(X_WB_, v_W, {sin_yaw * pitch_rate, -cos_yaw * pitch_rate, turn_radps_});
}

void NaiveDrive::make_safe(sim::SafeState safe) {
  rudder_ = elevator_ = 0;
  speed_target_mps_ = 0;
  if (safe == sim::SafeState::hold) return;
  heading_target_rad_ = depth_target_m_ = std::numeric_limits<double>::quiet_NaN();
}

void NaiveDrive::set_helm(double speed_mps, double heading_rad, double depth_m) {
  if (!std::isnan(speed_mps)) speed_target_mps_ = std::clamp(speed_mps, -params_.max_astern_mps, params_.max_speed_mps);
  if (!std::isnan(heading_rad)) heading_target_rad_ = sim::wrap_angle(heading_rad);
  if (!std::isnan(depth_m)) depth_target_m_ = world_.medium().has_water() ? std::max(0.0, depth_m) : depth_m;
}

void NaiveDrive::set_controls(double thrust, double rudder, double elevator) {
  thrust = std::clamp(thrust, -1.0, 1.0);
  speed_target_mps_ = thrust * (thrust > 0 ? params_.max_speed_mps : params_.max_astern_mps);
  rudder_ = std::clamp(rudder, -1.0, 1.0);
  elevator_ = std::clamp(elevator, -1.0, 1.0);
  heading_target_rad_ = depth_target_m_ = std::numeric_limits<double>::quiet_NaN();
}

void NaiveDrive::visit_state(sim::StateArchive& archive) {
  archive(speed_mps_, turn_radps_, climb_mps_, yaw_rad_, pitch_rad_, p_WB_, X_WB_, speed_target_mps_);
  archive.not_only_finite(heading_target_rad_, depth_target_m_);
  archive(rudder_, elevator_, left_the_current_);
}

void NaiveDriveController::receive(sim::Time, std::span<const std::byte> payload) {
  using shoal::Finite;
  const std::int64_t type = shoal::fingerprint(payload);
  if (type == shoal::fingerprint_of<shoal::thrust_rudder_command_t>()) {
    const auto command = shoal::decode<shoal::thrust_rudder_command_t>(payload, Finite::required);
    return drive_.set_controls(command.thrust, command.rudder, 0);
  }
  if (type == shoal::fingerprint_of<shoal::thrust_rudder_elevator_command_t>()) {
    const auto command = shoal::decode<shoal::thrust_rudder_elevator_command_t>(payload, Finite::required);
    return drive_.set_controls(command.thrust, command.rudder, command.elevator);
  }
  const auto command = shoal::decode<shoal::helm_command_t>(payload, Finite::any);
  for (const double value : {command.speed_mps, command.heading_rad, command.depth_m})
    // NaN is allowed in a helm command: as before.
    if (std::isinf(value)) throw std::runtime_error("speed, heading and depth must not be infinite");
  if (!std::isnan(command.altitude_m)) throw std::runtime_error("it holds no altitude: altitude_m must be NaN");
  if (drive_.surface() && !std::isnan(command.depth_m))
    throw std::runtime_error("a surface craft accepts no depth: depth_m must be NaN");
  drive_.set_helm(command.speed_mps, command.heading_rad, command.depth_m);
}

SHOAL_ACTUATOR("naive_drive", NaiveDrive, NaiveDriveController);

}  // namespace devices
