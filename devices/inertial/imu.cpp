// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/imu.hpp"

#include <numbers>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/imu_t.hpp"
#include "sim/config/presets.hpp"

namespace devices {

const sim::Presets& imu_presets();  // imu_presets.yaml

namespace {

/// Reads a number in data sheet units into a member in SI units.
void read_in(sim::ParamReader& in, const char* key, double& value, double unit_si, const char* meaning) {
  double number = value / unit_si;
  in.read(key, number, sim::at_least(0), meaning);
  if (in.has(key)) value = number * unit_si;
}

/// Reads the output limit; 0 in the struct: unlimited.
void read_range(sim::ParamReader& in, const char* key, double& value, double unit_si, const char* meaning) {
  double number = value / unit_si;
  in.read_or_word(key, number, sim::above(0), {"unlimited"}, meaning);
  if (in.has(key)) value = number * unit_si;
}

void read_gyro(sim::ParamReader& in, InertialParams& gyro) {
  read_in(in, "gyro_arw_deg_per_sqrt_h", gyro.random_walk, unit::deg_per_sqrt_h, "angle random walk (white noise)");
  read_in(in, "gyro_bias_instability_deg_per_h", gyro.bias_instability, unit::deg_per_h,
          "peak of the Allan deviation of the slow error (Gauss-Markov)");
  in.read("gyro_bias_time_s", gyro.bias_time_s, sim::above(0), "correlation time of the slow error");
  read_in(in, "gyro_rate_random_walk_deg_per_h_per_sqrt_h", gyro.rate_random_walk, unit::deg_per_h_per_sqrt_h,
          "drift that grows with the square root of time");
  read_in(in, "gyro_bias_deg_per_h", gyro.turn_on_bias, unit::deg_per_h,
          "turn-on bias: standard deviation, drawn once for each axis");
  read_in(in, "gyro_scale_ppm", gyro.scale, unit::ppm, "scale error: standard deviation, drawn once for each axis");
  read_in(in, "gyro_misalignment_mrad", gyro.misalignment_rad, unit::mrad,
          "misalignment: standard deviation, drawn once for each pair of axes");
  read_range(in, "gyro_range_dps", gyro.range, unit::degps, "limit of the magnitude of the output, deg/s");
  read_in(in, "gyro_resolution_dps", gyro.resolution, unit::degps, "deg/s, step of the output; 0: none");
}

void read_accel(sim::ParamReader& in, InertialParams& accel) {
  read_in(in, "accel_vrw_mps_per_sqrt_h", accel.random_walk, unit::mps_per_sqrt_h,
          "velocity random walk (white noise)");
  read_in(in, "accel_bias_instability_ug", accel.bias_instability, unit::ug,
          "peak of the Allan deviation of the slow error (Gauss-Markov)");
  in.read("accel_bias_time_s", accel.bias_time_s, sim::above(0), "correlation time of the slow error");
  read_in(in, "accel_random_walk_ug_per_sqrt_h", accel.rate_random_walk, unit::ug_per_sqrt_h,
          "drift that grows with the square root of time");
  read_in(in, "accel_bias_mg", accel.turn_on_bias, unit::mg,
          "turn-on bias: standard deviation, drawn once for each axis");
  read_in(in, "accel_scale_ppm", accel.scale, unit::ppm, "scale error: standard deviation, drawn once for each axis");
  read_in(in, "accel_misalignment_mrad", accel.misalignment_rad, unit::mrad,
          "misalignment: standard deviation, drawn once for each pair of axes");
  read_range(in, "accel_range_g", accel.range, unit::mps2_per_g, "limit of the magnitude of the output, g");
  read_in(in, "accel_resolution_mg", accel.resolution, unit::mg, "step of the output; 0: none");
}

double time_constant_s(double bandwidth_Hz) {
  return bandwidth_Hz > 0 ? 1 / (2 * std::numbers::pi * bandwidth_Hz) : 0;
}

}  // namespace

void Imu::Params::read(sim::ParamReader& in) {
  imu_presets().read(in, *this, {"ideal"}, "preset of a product by its data sheet; the keys below override it");
  in.read_or_word("bandwidth_Hz", bandwidth_Hz, sim::above(0), {"unlimited"},
                  "bandwidth of a first-order low pass on the true values");
  in.read("gyro_noise", gyro_noise, "further error of each axis, rad/s");
  read_gyro(in, gyro);
  in.read("accel_noise", accel_noise, "further error of each axis, m/s^2");
  read_accel(in, accel);
}

Imu::Imu(const Params& params, const sim::DeviceContext& context)
    : strapdown_(context),
      gyro_filter_(time_constant_s(params.bandwidth_Hz)),
      accel_filter_(time_constant_s(params.bandwidth_Hz)),
      gyro_errors_(params.gyro, params.gyro_noise, context),
      accel_errors_(params.accel, params.accel_noise, context) {}

void Imu::change(const Params& params) {
  gyro_filter_.change(time_constant_s(params.bandwidth_Hz));
  accel_filter_.change(time_constant_s(params.bandwidth_Hz));
  gyro_errors_.change(params.gyro, params.gyro_noise);
  accel_errors_.change(params.accel, params.accel_noise);
}

void Imu::measure(const sim::SenseContext& context) {
  strapdown_.measure(context);
  w_S_ = strapdown_.w_WS_S();
  f_S_ = strapdown_.f_S();
}

void Imu::disturb(double dt_s, sim::Random& random) {
  w_S_ = gyro_filter_.apply(w_S_, dt_s);
  f_S_ = accel_filter_.apply(f_S_, dt_s);
  gyro_errors_.apply(w_S_, dt_s, random);
  accel_errors_.apply(f_S_, dt_s, random);
}

void fill(const Imu& imu, shoal::imu_t& message) {
  for (int i = 0; i < 3; ++i) {
    message.angular_velocity_radps[i] = imu.angular_velocity_S_radps()[i];
    message.linear_acceleration_mps2[i] = imu.specific_force_S_mps2()[i];
  }
}

SHOAL_SENSOR("imu", Imu, shoal::imu_t);

}  // namespace devices
