// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/navigation/pressure.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// CTD: conductivity, temperature and pressure of the medium, each with its error.  Salinity and depth are computed
/// from the measured values.
class Ctd final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "CTD: conductivity, temperature, depth, salinity and speed of sound.";
  static constexpr double default_rate_hz = 4;
  struct Params {
    DepthFormula depth;
    sim::NoiseParams conductivity_noise;  ///< S/m
    sim::NoiseParams temperature_noise;   ///< degrees C
    sim::NoiseParams pressure_noise;      ///< Pa
    sim::NoiseParams sound_speed_noise;   ///< m/s
    void read(sim::ParamReader& in);
  };
  struct Reading {
    bool valid = false;  ///< true in water
    double conductivity_Spm = 0, temperature_C = 0, pressure_Pa = 0, sound_speed_mps = 0;
    void visit_state(sim::StateArchive& archive) {
      archive(valid, conductivity_Spm, temperature_C, pressure_Pa, sound_speed_mps);
    }
  };

  Ctd(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params) { params_ = params; }
  auto noises() { return std::tie(conductivity_noise_, temperature_noise_, pressure_noise_, sound_speed_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override {
    archive(conductivity_noise_, temperature_noise_, pressure_noise_, sound_speed_noise_, reading_);
  }
  const Reading& reading() const { return reading_; }
  double depth_m() const { return params_.depth.depth_m(reading_.pressure_Pa); }
  /// Returns the practical salinity computed from the measured values.
  double salinity_psu() const;

 private:
  /// Returns the gauge pressure, for the salinity scale.
  double pressure_dbar() const { return (reading_.pressure_Pa - params_.depth.assumed_surface_Pa) * 1e-4; }

  Params params_;
  sim::NoiseOf<&Params::conductivity_noise> conductivity_noise_;
  sim::NoiseOf<&Params::temperature_noise> temperature_noise_;
  sim::NoiseOf<&Params::pressure_noise> pressure_noise_;
  sim::NoiseOf<&Params::sound_speed_noise> sound_speed_noise_;
  Reading reading_;
};

}  // namespace devices
