// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/physics/joint.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Dead reckoning of a differential drive from quantized wheel ticks.  It uses assumed values of wheel radius and
/// track, which may be wrong, and ignores slip, so that the error grows as on a real rover.
class Odometry final : public sim::Sensor {
 public:
  static constexpr const char* meaning =
      "Position from the ticks of two wheels; errors by slip, ticks and calibration.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr double default_rate_hz = 20;
  struct Params {
    std::string left_joint;
    std::string right_joint;
    std::optional<double> wheel_radius_m, track_m;  ///< assumed; unset: as in the vehicle
    int ticks_per_revolution = 1024;
    sim::NoiseParams noise;  ///< error of the angle of each wheel between samples, rad
    void read(sim::ParamReader& in);
  };
  struct Reading {
    double x_m = 0, y_m = 0, theta_rad = 0;
    double forward_mps = 0, turn_radps = 0;
    std::int64_t left_ticks = 0, right_ticks = 0;
    void visit_state(sim::StateArchive& archive) {
      archive(x_m, y_m, theta_rad, forward_mps, turn_radps, left_ticks, right_ticks);
    }
  };

  Odometry(const Params& params, const sim::DeviceContext& context);
  /// Sets the true pose of the vehicle relative to its initial pose.
  void measure(const sim::SenseContext& context) override;
  /// Sets the measured pose by integration of the wheel ticks.
  void disturb(double dt_s, sim::Random& random) override;
  /// Returns the initial pose of the vehicle.
  std::optional<sim::Pose> origin() const override { return X_W0_; }
  void visit_state(sim::StateArchive& archive) override;
  const Reading& reading() const { return reading_; }

 private:
  Params params_;
  double wheel_radius_m_, track_m_;  ///< assumed
  const sim::Joint& left_;
  const sim::Joint& right_;
  sim::NoiseOf<&Params::noise> noise_;
  sim::Pose X_W0_;  ///< initial pose of the vehicle
  double truth_theta_rad_ = 0;
  double wheel_rad_[2] = {0, 0};     ///< true angles at the last sample
  double believed_rad_[2] = {0, 0};  ///< angles with noise, before quantization
  Reading reading_;
  Reading reckoned_;
};

}  // namespace devices
