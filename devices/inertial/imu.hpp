// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/inertial/inertial_errors.hpp"
#include "devices/inertial/strapdown.hpp"

namespace devices {

/// Inertial measurement unit: three gyros and three accelerometers in the axes of S, at the origin of S.
class Imu final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Gyros and accelerometers with the errors of a data sheet.";
  static constexpr bool measures_alone = true;
  static constexpr double default_rate_hz = 100;
  struct Params {
    std::string preset = "ideal";
    double bandwidth_Hz = 0;      ///< bandwidth of the output low-pass filter; 0: none
    sim::NoiseParams gyro_noise;  ///< rad/s, in addition to the errors of the data sheet
    InertialParams gyro;
    sim::NoiseParams accel_noise;  ///< m/s^2
    InertialParams accel;
    void read(sim::ParamReader& in);
  };

  Imu(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  void measure(const sim::SenseContext& context) override;
  void displaced() override {
    strapdown_.restart();
    gyro_filter_.restart();
    accel_filter_.restart();
  }
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override {
    archive(strapdown_, gyro_filter_, accel_filter_, gyro_errors_, accel_errors_, w_S_, f_S_);
  }

  const sim::Vector3d& angular_velocity_S_radps() const { return w_S_; }
  const sim::Vector3d& specific_force_S_mps2() const { return f_S_; }
  const InertialErrors& gyro_errors() const { return gyro_errors_; }
  const InertialErrors& accel_errors() const { return accel_errors_; }

 private:
  Strapdown strapdown_;
  LowPass gyro_filter_, accel_filter_;
  InertialErrors gyro_errors_, accel_errors_;
  sim::Vector3d w_S_ = sim::Vector3d::Zero();
  sim::Vector3d f_S_ = sim::Vector3d::Zero();
};

}  // namespace devices
