// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/ahrs.hpp"

#include <limits>

#include "shoal/ins_t.hpp"
#include "shoal/message_codec.hpp"

namespace devices {

void Ahrs::Params::read(sim::ParamReader& in) {
  in.read("tilt_noise", tilt_noise, "error angles about east and north, rad (mostly gauss_markov_std)");
  in.read("heading_noise", heading_noise, "error angle about up, counter-clockwise, rad");
  double drift_deg_per_h = sim::radians_to_degrees(heading_drift_rad_per_s) * 3600;
  in.read("heading_drift_deg_per_h", drift_deg_per_h, sim::any_number(), "steady growth of the heading's error");
  heading_drift_rad_per_s = sim::degrees_to_radians(drift_deg_per_h) / 3600;
  in.read("gyro_noise", gyro_noise, "error of each axis of the angular velocity, rad/s");
  in.read("accel_noise", accel_noise, "error of each axis of the specific force, m/s^2");
}

Ahrs::Ahrs(const Params& params, const sim::DeviceContext& context)
    : heading_drift_rad_per_s_(params.heading_drift_rad_per_s),
      strapdown_(context),
      tilt_noise_(context.noise(params.tilt_noise, 2, "tilt_noise")),
      heading_noise_(context.noise(params.heading_noise, 1, "heading_noise")),
      gyro_noise_(context.noise(params.gyro_noise, 3, "gyro_noise")),
      accel_noise_(context.noise(params.accel_noise, 3, "accel_noise")) {}

void Ahrs::change(const Params& params) {
  heading_drift_rad_per_s_ = params.heading_drift_rad_per_s;
  tilt_noise_.change(params.tilt_noise);
  heading_noise_.change(params.heading_noise);
  gyro_noise_.change(params.gyro_noise);
  accel_noise_.change(params.accel_noise);
}

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

void AhrsReporter::report(sim::Time sampled_at, sim::Publisher& out) const {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const sim::Quaterniond& q = ahrs_.q_WS();
  const double sign = q.w() < 0 ? -1 : 1;  // of the two quaternions of a rotation the one with w >= 0
  shoal::ins_t message;
  message.utime = out.utime(sampled_at);
  message.device_time = message.utime;
  for (int i = 0; i < 3; ++i) {
    message.gyro[i] = ahrs_.angular_velocity_S_radps()[i];
    message.mag[i] = nothing;
    message.accel[i] = ahrs_.specific_force_S_mps2()[i];
    message.quat[i + 1] = sign * q.vec()[i];
  }
  message.quat[0] = sign * q.w();
  message.pressure = nothing;
  message.rel_alt = nothing;
  shoal::encode_into(message, out.buffer());
  out.publish(out.buffer());
}

SHOAL_SENSOR("ahrs", Ahrs, AhrsReporter);

}  // namespace devices
