// SPDX-License-Identifier: BSD-3-Clause
#include "tools/autonomy/missions/robots/balance.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shoal/message_codec.hpp"

namespace autonomy {

namespace {

/// Maximum lead of a tilt; a later one belongs to another clock.
constexpr double max_late_s = 0.1;
/// Maximum interval between tilts whose difference is used as a rate.
constexpr double tilt_gap_s = 1;

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
  for (const double number : {params.period_s, params.wheel_radius_m, params.track_m, params.max_torque_Nm,
                              params.fallen_rad, params.max_acceleration_mps2})
    if (!(number > 0)) throw std::invalid_argument("period, sizes and limits must be above 0");
}

void Balance::receive(const shoal::inclination_t& message) {
  // Floating point, because the difference of two integers may overflow.
  const double dt_s = (static_cast<double>(message.utime) - static_cast<double>(tilt_utime_)) * 1e-6;
  const bool late = dt_s <= 0 && dt_s > -max_late_s;
  if (tilt_known_ && late) return;
  // Other times: the clock was set, or the last message had its own time.  The rate is kept.
  if (tilt_known_ && dt_s > 0 && dt_s < tilt_gap_s) {
    const double rate_radps = (message.pitch_rad - tilt_rad_) / dt_s;
    rate_radps_ += share(dt_s, params_.rate_filter_s) * (rate_radps - rate_radps_);
  }
  tilt_rad_ = message.pitch_rad;
  tilt_utime_ = message.utime;
  tilt_known_ = true;
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
  asked_mps_ = forward_mps;
  asked_turn_radps_ = turn_radps;
}

std::optional<Balance::Torques> Balance::step() {
  if (!tilt_known_ || !wheels_known_) return std::nullopt;
  const Params& p = params_;
  if (std::abs(tilt_rad_ - p.balanced_tilt_rad) > p.fallen_rad) fallen_ = true;
  if (fallen_) return Torques{};

  // The encoders measure the rotation of the wheels relative to the body, which rotates itself.
  const double part = share(p.period_s, p.speed_filter_s);
  const double rolled_mps = p.wheel_radius_m * ((left_radps_ + right_radps_) / 2 + rate_radps_);
  speed_mps_ += part * (rolled_mps - speed_mps_);
  turn_radps_ += part * (p.wheel_radius_m * (right_radps_ - left_radps_) / p.track_m - turn_radps_);

  // PI law from speed to tilt.
  const double max_change = p.max_acceleration_mps2 * p.period_s;
  desired_mps_ += std::clamp(asked_mps_ - desired_mps_, -max_change, max_change);
  const double slow_mps = desired_mps_ - speed_mps_;
  const double by_speed_rad = p.kv_rad_per_mps * slow_mps;
  const double by_distance_rad = p.ki_rad_per_m * (distance_m_ + slow_mps * p.period_s);
  // The integral is held while the tilt is limited (anti-windup).
  if (std::abs(by_speed_rad + by_distance_rad) < p.max_tilt_rad) distance_m_ += slow_mps * p.period_s;
  const double desired_rad =
      p.balanced_tilt_rad + std::clamp(by_speed_rad + by_distance_rad, -p.max_tilt_rad, p.max_tilt_rad);

  // PD law from tilt to the common torque.
  const double both_Nm = p.kp_Nm_per_rad * (tilt_rad_ - desired_rad) + p.kd_Nms_per_rad * rate_radps_;
  // PI law from yaw rate to the difference of the torques.
  const double slow_radps = asked_turn_radps_ - turn_radps_;
  const double max_rad = p.turn_ki_Nm_per_rad > 0 ? p.max_torque_Nm / p.turn_ki_Nm_per_rad : 0;
  turned_rad_ = std::clamp(turned_rad_ + slow_radps * p.period_s, -max_rad, max_rad);
  const double between_Nm = p.turn_gain_Nms_per_rad * slow_radps + p.turn_ki_Nm_per_rad * turned_rad_;
  const auto cut = [&p](double torque_Nm) { return std::clamp(torque_Nm, -p.max_torque_Nm, p.max_torque_Nm); };
  return Torques{cut((both_Nm - between_Nm) / 2), cut((both_Nm + between_Nm) / 2)};
}

}  // namespace autonomy
