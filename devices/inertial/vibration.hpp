// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/inertial/strapdown.hpp"
#include "sim/random/noise.hpp"

namespace devices {

/// Vibration sensor: root mean square and peak of the acceleration within a band, of each step since the last report.
/// The band is a first-order low pass and a first-order high pass, one after the other: each falls by 3 dB at its end
/// of the band and by 6 dB an octave beyond it.  In the middle of a band of a decade or more the gain is above 0.9, at
/// that of a narrow one 0.5.  Gravity is in it where the sensor turns within the band.  Nothing is known above half the
/// rate of the steps.
class Vibration final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Vibration: root mean square and peak of the acceleration within a band.";
  static constexpr double default_rate_hz = 10;
  struct Params {
    double low_Hz = 10, high_Hz = 200;
    sim::NoiseParams noise;
    void read(sim::ParamReader& in);
  };

  Vibration(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  auto noises() { return std::tie(noise_); }
  /// Takes the motion of the last step.
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext& context) override;
  void displaced() override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override {
    archive(strapdown_, below_high_, below_low_, noise_, squares_, count_, greatest_, rms_mps2_, peak_mps2_);
  }

  double rms_mps2() const { return rms_mps2_; }
  double peak_mps2() const { return peak_mps2_; }

 private:
  const sim::World& world_;
  const sim::Vehicle& vehicle_;
  const sim::Body& body_;
  const sim::Pose X_BS_;
  Strapdown strapdown_;
  LowPass below_high_, below_low_;
  sim::NoiseOf<&Params::noise> noise_;
  double squares_ = 0, greatest_ = 0;  ///< since the last sample
  std::int64_t count_ = 0;
  double rms_mps2_ = 0, peak_mps2_ = 0;
};

}  // namespace devices
