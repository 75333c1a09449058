// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/wind_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/wind_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

/// Returns the wind of air that moves with a velocity, forward and left.
WindSensor::Wind wind_of(const Eigen::Vector2d& velocity) {
  return {velocity.norm(), velocity.isZero() ? 0 : std::atan2(velocity.y(), -velocity.x())};
}

Eigen::Vector2d velocity_of(const WindSensor::Wind& wind) {
  return wind.speed_mps * Eigen::Vector2d(-std::cos(wind.angle_rad), std::sin(wind.angle_rad));
}

}  // namespace

void WindSensor::Params::read(sim::ParamReader& in) {
  in.read("threshold_mps", threshold_mps, sim::at_least(0), "below this apparent speed its cups stand still: 0");
  in.read("speed_max_mps", speed_max_mps, sim::above(0), "maximum speed that it reports");
  in.read("speed_noise", speed_noise, "error of the apparent speed, m/s");
  in.read("angle_noise", angle_noise, "error of the apparent angle, rad");
  in.read("velocity_noise", velocity_noise,
          "error of each component of the velocity over ground, for the true wind, m/s");
  in.read("heading_noise", heading_noise, "error of the heading, for the direction of the true wind, rad");
}

WindSensor::WindSensor(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      speed_noise_(context, params),
      angle_noise_(context, params),
      velocity_noise_(context, params, 2),
      heading_noise_(context, params) {}

void WindSensor::measure(const sim::SenseContext& context) {
  const sim::Medium& medium = context.world.medium();
  const sim::Matrix3d R_SW = context.X_WS.linear().transpose();
  const sim::Vector3d& p_WS = context.X_WS.translation();
  valid_ = !medium.in_water(p_WS);
  v_WS_S_ = (R_SW * context.v_WS_W).head<2>();
  yaw_rad_ = sim::yaw_of(context.X_WS.linear());
  apparent_ = wind_of((R_SW * (medium.air_velocity_W(p_WS) - context.v_WS_W)).head<2>());
}

void WindSensor::disturb(double dt_s, sim::Random& random) {
  speed_noise_.apply(apparent_.speed_mps, dt_s, random);
  angle_noise_.apply(apparent_.angle_rad, dt_s, random);
  velocity_noise_.apply(std::span<double>(v_WS_S_.data(), 2), dt_s, random);
  heading_noise_.apply(yaw_rad_, dt_s, random);
  apparent_.angle_rad = sim::wrap_angle(apparent_.angle_rad);
  apparent_.speed_mps = std::clamp(apparent_.speed_mps, 0.0, params_.speed_max_mps);
  if (apparent_.speed_mps < params_.threshold_mps) apparent_.speed_mps = 0;
}

WindSensor::Wind WindSensor::true_wind() const {
  return wind_of(velocity_of(apparent_) + v_WS_S_);
}

double WindSensor::true_direction_rad() const {
  const double direction_rad = sim::wrap_angle(std::numbers::pi / 2 - yaw_rad_ + true_wind().angle_rad);
  return direction_rad < 0 ? direction_rad + 2 * std::numbers::pi : direction_rad;
}

void WindSensor::visit_state(sim::StateArchive& archive) {
  archive(speed_noise_, angle_noise_, velocity_noise_, heading_noise_, valid_, apparent_.speed_mps, apparent_.angle_rad,
          v_WS_S_, yaw_rad_);
}

void fill(const WindSensor& sensor, shoal::wind_t& message) {
  const bool valid = sensor.valid();
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const WindSensor::Wind over_ground = sensor.true_wind();
  message.valid = valid;
  message.apparent_speed_mps = valid ? sensor.apparent().speed_mps : nothing;
  message.apparent_angle_rad = valid ? sensor.apparent().angle_rad : nothing;
  message.true_speed_mps = valid ? over_ground.speed_mps : nothing;
  message.true_angle_rad = valid ? over_ground.angle_rad : nothing;
  message.true_direction_rad = valid ? sensor.true_direction_rad() : nothing;
}

SHOAL_SENSOR("wind_sensor", WindSensor, shoal::wind_t);

}  // namespace devices
