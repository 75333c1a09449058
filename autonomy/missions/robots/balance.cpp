// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/balance.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shoal/message_codec.hpp"

namespace autonomy {

namespace {

constexpr double gravity_mps2 = 9.80665;

/// Gain of a first-order low-pass filter for a time step.
double share(double time_s, double time_constant_s) {
  return time_s / (time_s + time_constant_s);
}

}  // namespace

void check_speeds(const std::vector<SpeedPoint>& points) {
  for (std::size_t i = 1; i < points.size(); ++i)
    if (!(points[i].from_s > points[i - 1].from_s))
      throw std::invalid_argument("the times of the speeds must increase");
}

Balance::Balance(const Params& params) : params_(params) {
  if (params.filter_s > 0) filter_.emplace(params.filter_s);
  for (const double number : {params.period_s, params.wheel_radius_m, params.track_m, params.max_torque_Nm,
                              params.fallen_rad, params.max_acceleration_mps2, params.max_tilt_speed_mps})
    if (!(number > 0)) throw std::invalid_argument("period, sizes and limits must be above 0");
}

void Balance::receive(const shoal::inclination_t& message) {
  if (filter_) return filter_->correct(message.utime, without_acceleration(message.pitch_rad));
  bool is_new = false;
  const auto dt_s = tilt_interval_.take(message.utime, is_new);
  if (!is_new) return;
  // After a jump of the clock the rate is kept.
  if (dt_s) take_rate((message.pitch_rad - tilt_rad_) / *dt_s, *dt_s);
  tilt_rad_ = message.pitch_rad;
  tilt_known_ = true;
}

void Balance::receive(const shoal::imu_t& message) {
  if (!filter_ || !filter_->predict(message.utime, message.angular_velocity_radps[1]) || !filter_->known()) return;
  take_rate(filter_->rate_radps(), params_.period_s);
  tilt_rad_ = filter_->tilt_rad();
  tilt_known_ = true;
}

/// An inclinometer measures the direction of the specific force: tilt - acceleration / g for small angles.
double Balance::without_acceleration(double inclination_rad) const {
  return was_tilted_ ? inclination_rad + acceleration_mps2_ / gravity_mps2 : inclination_rad;
}

void Balance::take_rate(double rate_radps, double dt_s) {
  rate_radps_ += share(dt_s, params_.rate_filter_s) * (rate_radps - rate_radps_);
}

void Balance::receive(const shoal::wheel_encoder_t& message) {
  if (message.rate_radps.size() != 2)
    throw shoal::MessageError("it needs the rates of two wheels, got " + std::to_string(message.rate_radps.size()));
  left_radps_ = message.rate_radps[0];
  right_radps_ = message.rate_radps[1];
  wheels_known_ = true;
}

void Balance::receive(const shoal::twist_command_t& message) {
  drive(message.forward_mps, message.turn_radps);
}

void Balance::drive(double forward_mps, double turn_radps) {
  asked_tilt_rad_.reset();
  asked_mps_ = forward_mps;
  asked_turn_radps_ = turn_radps;
}

/// PI law from speed to tilt.
double Balance::tilt_for_speed() {
  const Params& p = params_;
  const double max_change = p.max_acceleration_mps2 * p.period_s;
  desired_mps_ += std::clamp(asked_mps_ - desired_mps_, -max_change, max_change);
  const double slow_mps = desired_mps_ - speed_mps_;
  const double by_speed_rad = p.kv_rad_per_mps * slow_mps;
  const double by_distance_rad = p.ki_rad_per_m * (distance_m_ + slow_mps * p.period_s);
  // The integral is held while the tilt is limited (anti-windup).
  if (std::abs(by_speed_rad + by_distance_rad) < p.max_tilt_rad) distance_m_ += slow_mps * p.period_s;
  return by_speed_rad + by_distance_rad;
}

/// Returns the commanded tilt; near the largest speed no more than keeps it.  0 while it drives at a speed.
double Balance::commanded_tilt_rad() const {
  if (!asked_tilt_rad_) return 0;
  const Params& p = params_;
  const double tilt_rad = std::clamp(*asked_tilt_rad_, p.kv_rad_per_mps * (-p.max_tilt_speed_mps - speed_mps_),
                                     p.kv_rad_per_mps * (p.max_tilt_speed_mps - speed_mps_));
  return std::clamp(tilt_rad, -p.max_tilt_rad, p.max_tilt_rad);
}

/// Tilts from the balance that the integral of the speed law has found, which is held.
double Balance::tilt_for_command() {
  desired_mps_ = speed_mps_;  // from which a later speed command starts
  return commanded_tilt_rad() + params_.ki_rad_per_m * distance_m_;
}

std::optional<Balance::Torques> Balance::step() {
  if (!tilt_known_ || !wheels_known_) return std::nullopt;
  const Params& p = params_;
  if (std::abs(tilt_rad_ - p.balanced_tilt_rad) > p.fallen_rad) fallen_ = true;
  if (fallen_) return Torques{};

  // The encoders measure the rotation of the wheels relative to the body, which rotates itself.
  const double part = share(p.period_s, p.speed_filter_s);
  const double rolled_mps = p.wheel_radius_m * ((left_radps_ + right_radps_) / 2 + rate_radps_);
  const double before_mps = speed_mps_;
  speed_mps_ += part * (rolled_mps - speed_mps_);
  constexpr double inclinometer_filter_s = 0.3;  // that of the device, so that both are late alike
  acceleration_mps2_ +=
      share(p.period_s, inclinometer_filter_s) * ((speed_mps_ - before_mps) / p.period_s - acceleration_mps2_);
  turn_radps_ += part * (p.wheel_radius_m * (right_radps_ - left_radps_) / p.track_m - turn_radps_);

  // Desired tilt, by the speed or as commanded.
  const double from_balance_rad = asked_tilt_rad_ ? tilt_for_command() : tilt_for_speed();
  const double desired_rad = p.balanced_tilt_rad + std::clamp(from_balance_rad, -p.max_tilt_rad, p.max_tilt_rad);

  // PD law from tilt to the common torque.
  const double both_Nm = p.kp_Nm_per_rad * (tilt_rad_ - desired_rad) + p.kd_Nms_per_rad * rate_radps_ +
                         p.tilt_torque_Nm_per_rad * commanded_tilt_rad();
  // PI law from yaw rate to the difference of the torques.
  const double slow_radps = asked_turn_radps_ - turn_radps_;
  const double max_rad = p.turn_ki_Nm_per_rad > 0 ? p.max_torque_Nm / p.turn_ki_Nm_per_rad : 0;
  turned_rad_ = std::clamp(turned_rad_ + slow_radps * p.period_s, -max_rad, max_rad);
  const double between_Nm = p.turn_gain_Nms_per_rad * slow_radps + p.turn_ki_Nm_per_rad * turned_rad_;
  const auto cut = [&p](double torque_Nm) { return std::clamp(torque_Nm, -p.max_torque_Nm, p.max_torque_Nm); };
  return Torques{cut((both_Nm - between_Nm) / 2), cut((both_Nm + between_Nm) / 2)};
}

}  // namespace autonomy
