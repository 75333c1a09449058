// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Paddle wheel or pitot tube: speed of the sensor through the water along +x of its frame.
class WaterSpeed final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Paddle wheel or pitot tube: speed through the water along its x axis.";
  static constexpr double default_rate_hz = 5;
  /// Sign of the measured speed.
  enum class Senses {
    both,
    forward,    ///< 0 for flow from behind, like a pitot tube
    magnitude,  ///< absolute value, as a paddle wheel
  };
  struct Params {
    Senses senses = Senses::both;
    double threshold_mps = 0;
    double speed_max_mps = 20;
    sim::NoiseParams speed_noise;  ///< m/s
    void read(sim::ParamReader& in);
  };

  WaterSpeed(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params) { params_ = params; }
  auto noises() { return std::tie(speed_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override;
  double speed_mps() const { return speed_mps_; }
  bool valid() const { return valid_; }

 private:
  Params params_;
  sim::NoiseOf<&Params::speed_noise> speed_noise_;
  double speed_mps_ = 0;
  bool valid_ = false;
};

}  // namespace devices
