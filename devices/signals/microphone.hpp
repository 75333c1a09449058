// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "devices/signals/speaker.hpp"
#include "sim/random/noise.hpp"

namespace devices {

/// Microphone in air that measures the level of what speakers play, and the direction of the loudest one.
///
/// The level of each falls by spherical spreading, L(r) = L(1 m) - 20 lg(r / 1 m), and powers add (Kinsler, Frey,
/// Coppens and Sanders, Fundamentals of Acoustics, 4th ed., 2000, sections 5.11 and 5.12).  Travel time, absorption,
/// reflection and shadows of bodies are left out: sounds arrive at once, and through walls.
class Microphone final : public sim::Sensor, public sim::UnhashedUntilUsed {
 public:
  static constexpr const char* meaning = "Microphone in air: level of what speakers play, direction of the loudest.";
  static constexpr double default_rate_hz = 20;
  struct Params {
    double ambient_dB = 35;
    sim::NoiseParams level_noise, bearing_noise;
    void read(sim::ParamReader& in);
  };

  Microphone(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params) { params_ = params; }
  auto noises() { return std::tie(level_noise_, bearing_noise_); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override {
    archive(level_noise_, bearing_noise_, used_, is_update_, sound_, level_dB_, bearing_rad_, elevation_rad_);
  }
  bool used() const override { return used_; }

  /// Returns whether a sound is above the ambient noise, or was at the last sample.
  bool is_update() const { return is_update_; }
  const std::string& sound() const { return sound_; }
  double level_dB() const { return level_dB_; }
  double bearing_rad() const { return bearing_rad_; }
  double elevation_rad() const { return elevation_rad_; }

 private:
  Params params_;
  const SpeakersInAir& in_air_;
  sim::NoiseOf<&Params::level_noise> level_noise_;
  sim::NoiseOf<&Params::bearing_noise> bearing_noise_;
  bool used_ = false, is_update_ = false;
  std::string sound_;
  double level_dB_ = 0, bearing_rad_ = 0, elevation_rad_ = 0;
};

}  // namespace devices
