// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Leak detector: reports the volume of water in the hull.  Water enters below the rated depth of the hull, or while an
/// event sets `leaking`.  The mass of the vehicle does not change.
class Leak final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Leak detector: water in the hull, from too great a depth or from an event.";
  static constexpr double default_rate_hz = 1;
  struct Params {
    std::optional<double> rated_depth_m;
    bool leaking = false;
    double ingress_lps = 0.05;
    double alarm_l = 0.01;
    double volume_l = 10;
    sim::NoiseParams water_noise;  ///< liters
    void read(sim::ParamReader& in);
  };

  Leak(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params) { params_ = params; }
  auto noises() { return std::tie(water_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override;
  double water_l() const { return reading_l_; }
  bool leak() const { return reading_l_ >= params_.alarm_l; }

 private:
  Params params_;
  sim::NoiseOf<&Params::water_noise> water_noise_;
  double water_l_ = 0;  ///< true volume in the hull
  bool burst_ = false;  ///< rated depth was exceeded: permanent leak under water
  double reading_l_ = 0;
};

}  // namespace devices
