// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/ahrs.hpp"

#include <limits>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/ins_t.hpp"

namespace devices {

void Ahrs::Params::read(sim::ParamReader& in) {
  in.read("tilt_noise", tilt_noise, "error angles about east and north, rad (mostly gauss_markov_std)");
  in.read("heading_noise", heading_noise, "error angle about up, counter-clockwise, rad");
  double drift_deg_per_h = sim::radians_to_degrees(heading_drift_rad_per_s) * 3600;
  in.read("heading_drift_deg_per_h", drift_deg_per_h, sim::any_number(), "constant drift of the heading");
  heading_drift_rad_per_s = sim::degrees_to_radians(drift_deg_per_h) / 3600;
  in.read("gyro_noise", gyro_noise, "error of each axis of the angular velocity, rad/s");
  in.read("accel_noise", accel_noise, "error of each axis of the specific force, m/s^2");
}

Ahrs::Ahrs(const Params& params, const sim::DeviceContext& context)
    : heading_drift_rad_per_s_(params.heading_drift_rad_per_s),
      strapdown_(context),
      tilt_noise_(context, params, 2),
      heading_noise_(context, params),
      gyro_noise_(context, params, 3),
      accel_noise_(context, params, 3) {}

void Ahrs::measure(const sim::SenseContext& context) {
  strapdown_.measure(context);
  q_WS_ = sim::Quaterniond(context.X_WS.linear());
  w_S_ = strapdown_.w_WS_S();
  f_S_ = strapdown_.f_S();
}

void Ahrs::disturb(double dt_s, sim::Random& random) {
  drifted_rad_ += heading_drift_rad_per_s_ * dt_s;
  sim::Vector3d error_W_rad(0, 0, drifted_rad_);
  tilt_noise_.apply(std::span<double>(error_W_rad.data(), 2), dt_s, random);
  heading_noise_.apply(error_W_rad.z(), dt_s, random);
  q_WS_ = rotation_of(error_W_rad) * q_WS_;
  gyro_noise_.apply(std::span<double>(w_S_.data(), 3), dt_s, random);
  accel_noise_.apply(std::span<double>(f_S_.data(), 3), dt_s, random);
}

// Publishes shoal.ins_t, equal on the wire to bot_core's.
void fill(const Ahrs& ahrs, shoal::ins_t& message) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const sim::Quaterniond& q = ahrs.q_WS();
  const double sign = q.w() < 0 ? -1 : 1;  // choose the quaternion with w >= 0 of the two of a rotation
  message.device_time = message.utime;
  for (int i = 0; i < 3; ++i) {
    message.gyro[i] = ahrs.angular_velocity_S_radps()[i];
    message.mag[i] = nothing;
    message.accel[i] = ahrs.specific_force_S_mps2()[i];
    message.quat[i + 1] = sign * q.vec()[i];
  }
  message.quat[0] = sign * q.w();
  message.pressure = nothing;
  message.rel_alt = nothing;
}

SHOAL_SENSOR("ahrs", Ahrs, shoal::ins_t);

}  // namespace devices
