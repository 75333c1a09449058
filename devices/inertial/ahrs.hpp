// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/inertial/strapdown.hpp"
#include "sim/random/noise.hpp"

namespace devices {

/// Attitude and heading reference system (AHRS): orientation, angular velocity and specific force.  Instead of its
/// filter, the residual error is simulated: a small rotation about east and north (tilt) and about up (heading), in the
/// world frame.
class Ahrs final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Orientation with small errors of tilt and heading, rates and accelerations.";
  static constexpr bool measures_alone = true;
  static constexpr double default_rate_hz = 50;
  struct Params {
    sim::NoiseParams tilt_noise;     ///< rotation about east and about north, rad
    sim::NoiseParams heading_noise;  ///< rotation about up, rad
    double heading_drift_rad_per_s = 0;
    sim::NoiseParams gyro_noise;   ///< rad/s
    sim::NoiseParams accel_noise;  ///< m/s^2
    void read(sim::ParamReader& in);
  };

  Ahrs(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params) { heading_drift_rad_per_s_ = params.heading_drift_rad_per_s; }
  auto noises() { return std::tie(tilt_noise_, heading_noise_, gyro_noise_, accel_noise_); }
  void measure(const sim::SenseContext& context) override;
  void displaced() override { strapdown_.restart(); }
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override {
    archive(drifted_rad_, strapdown_, tilt_noise_, heading_noise_, gyro_noise_, accel_noise_, q_WS_, w_S_, f_S_);
  }

  const sim::Quaterniond& q_WS() const { return q_WS_; }
  const sim::Vector3d& angular_velocity_S_radps() const { return w_S_; }
  const sim::Vector3d& specific_force_S_mps2() const { return f_S_; }

 private:
  double heading_drift_rad_per_s_;
  double drifted_rad_ = 0;
  Strapdown strapdown_;
  sim::NoiseOf<&Params::tilt_noise> tilt_noise_;
  sim::NoiseOf<&Params::heading_noise> heading_noise_;
  sim::NoiseOf<&Params::gyro_noise> gyro_noise_;
  sim::NoiseOf<&Params::accel_noise> accel_noise_;
  sim::Quaterniond q_WS_ = sim::Quaterniond::Identity();
  sim::Vector3d w_S_ = sim::Vector3d::Zero();
  sim::Vector3d f_S_ = sim::Vector3d::Zero();
};

}  // namespace devices
