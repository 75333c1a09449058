// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "devices/inertial/inclinometer.hpp"

namespace devices {

/// Three-axis magnetometer and its magnetic heading.  The magnetic field of the earth is uniform in the world.
/// Measurement: soft iron * field + hard iron + noise; hard iron is a constant field that turns with the sensor, soft
/// iron distorts the external field (Gebre-Egziabher et al., Calibration of strapdown magnetometers in magnetic field
/// domain, J. Aerosp. Eng. 19(2), 2006).
class Compass final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Magnetic heading and field, with hard and soft iron.";
  static constexpr bool measures_alone = true;
  static constexpr double default_rate_hz = 10;
  enum class TiltCompensation { none, ideal, accelerometer };
  struct Params {
    // The World Magnetic Model 2025 at the default origin (42.36 N 71.09 W, Cambridge, Massachusetts) at the start of
    // 2026: -13.97 deg, 66.26 deg, 51.22 uT; computed from the NOAA coefficients and checked against the declinations
    // of the NOAA test values.
    double declination_rad = sim::degrees_to_radians(-14.0);
    double inclination_rad = sim::degrees_to_radians(66.3);
    double field_uT = 51.2;
    double declination_correction_rad = 0;
    sim::Vector3d hard_iron_uT = sim::Vector3d::Zero();
    std::vector<double> soft_iron = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< matrix, row by row
    TiltCompensation tilt_compensation = TiltCompensation::accelerometer;
    double tilt_time_s = 0.3;
    sim::NoiseParams field_noise;    ///< of each axis, uT
    sim::NoiseParams heading_noise;  ///< rad
    void read(sim::ParamReader& in);
  };
  struct Reading {
    double heading_rad = 0;       ///< from magnetic north, clockwise, [0, 2 pi)
    double heading_true_rad = 0;  ///< from true north, with the configured declination
    sim::Vector3d field_S_uT = sim::Vector3d::Zero();
    void visit_state(sim::StateArchive& archive) { archive(heading_rad, heading_true_rad, field_S_uT); }
  };

  Compass(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  auto noises() { return std::tie(field_noise_, heading_noise_); }
  void measure(const sim::SenseContext& context) override;
  void displaced() override {
    strapdown_.restart();
    tilt_filter_.restart();
  }
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override {
    archive(strapdown_, tilt_filter_, field_noise_, heading_noise_, reading_);
  }
  const Reading& reading() const { return reading_; }

 private:
  /// Returns the heading from the field and the upward direction, both in S.
  static double heading_of(const sim::Vector3d& field_S, const sim::Vector3d& up_S);

  Params params_;
  Strapdown strapdown_;
  LowPass tilt_filter_;
  sim::NoiseOf<&Params::field_noise> field_noise_;
  sim::NoiseOf<&Params::heading_noise> heading_noise_;
  sim::Vector3d up_S_ = sim::Vector3d::UnitZ();
  Reading reading_;
};

}  // namespace devices
