// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/param_reader.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Conversion of pressure to depth by a sensor; read from the map of the device.
struct DepthFormula {
  double assumed_density_kgpm3 = 1025;
  double assumed_gravity_mps2 = 9.80665;
  double assumed_surface_Pa = 101325;
  void read(sim::ParamReader& in);
  /// Returns (p - surface pressure) / (density gravity), m; `pressure_Pa` is absolute.
  double depth_m(double pressure_Pa) const {
    return (pressure_Pa - assumed_surface_Pa) / (assumed_density_kgpm3 * assumed_gravity_mps2);
  }
};

/// Pressure sensor: absolute pressure of the water or air at the sensor, and the depth computed from it.
class Pressure final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Pressure sensor: absolute pressure, depth, temperature.";
  static constexpr bool measures_alone = true;
  static constexpr double default_rate_hz = 10;
  struct Params {
    DepthFormula depth;
    sim::NoiseParams pressure_noise;     ///< Pa
    sim::NoiseParams temperature_noise;  ///< degrees C
    void read(sim::ParamReader& in);
  };

  Pressure(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params) { params_ = params; }
  auto noises() { return std::tie(pressure_noise_, temperature_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override;

  double pressure_Pa() const { return pressure_Pa_; }
  double depth_m() const { return params_.depth.depth_m(pressure_Pa_); }
  double temperature_C() const { return temperature_C_; }

 private:
  Params params_;
  sim::NoiseOf<&Params::pressure_noise> pressure_noise_;
  sim::NoiseOf<&Params::temperature_noise> temperature_noise_;
  double pressure_Pa_ = 0, temperature_C_ = 0;
};

}  // namespace devices
