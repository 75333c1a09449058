// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Anemometer with a vane: the apparent wind in the x-y plane of its frame S, and the true wind, which its instrument
/// computes from the apparent wind, the velocity over ground and the heading.  Waves and buildings do not disturb the
/// wind, and a heel tilts the sensor.
class WindSensor final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Anemometer: apparent and true wind, by speed and direction.";
  static constexpr bool measures_alone = true;
  static constexpr double default_rate_hz = 2;
  struct Params {
    double threshold_mps = 0;
    double speed_max_mps = 60;
    sim::NoiseParams speed_noise;     ///< of the apparent wind, m/s
    sim::NoiseParams angle_noise;     ///< of the apparent wind, rad
    sim::NoiseParams velocity_noise;  ///< of each component of the velocity over ground, m/s
    sim::NoiseParams heading_noise;   ///< rad
    void read(sim::ParamReader& in);
  };

  WindSensor(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params) { params_ = params; }
  auto noises() { return std::tie(speed_noise_, angle_noise_, velocity_noise_, heading_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override;

  /// Wind in a horizontal plane, where it comes from.
  struct Wind {
    double speed_mps = 0;
    double angle_rad = 0;  ///< clockwise from x of S, seen from above
  };
  bool valid() const { return valid_; }
  const Wind& apparent() const { return apparent_; }
  /// Returns the true wind by the present apparent wind, velocity and heading.
  Wind true_wind() const;
  /// Returns where the true wind comes from, clockwise from y of the world, 0 to 2 pi.
  double true_direction_rad() const;

 private:
  Params params_;
  sim::NoiseOf<&Params::speed_noise> speed_noise_;
  sim::NoiseOf<&Params::angle_noise> angle_noise_;
  sim::NoiseOf<&Params::velocity_noise> velocity_noise_;
  sim::NoiseOf<&Params::heading_noise> heading_noise_;
  bool valid_ = false;
  Wind apparent_;
  Eigen::Vector2d v_WS_S_ = Eigen::Vector2d::Zero();  ///< over ground, forward and left
  double yaw_rad_ = 0;
};

}  // namespace devices
