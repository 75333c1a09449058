// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/inertial/strapdown.hpp"
#include "sim/random/noise.hpp"

namespace devices {

/// Roll and pitch of a sensor frame when the specific force is taken as the upward direction: correct at rest, in error
/// while the sensor is accelerated.
struct Tilt {
  double roll_rad = 0;   ///< as in Rz(yaw) Ry(pitch) Rx(roll)
  double pitch_rad = 0;  ///< positive: the nose is down
  void visit_state(sim::StateArchive& archive) { archive(roll_rad, pitch_rad); }
};
Tilt tilt_of(const sim::Vector3d& up_S);

/// Inclinometer: measures roll and pitch from the specific force, as real ones do.  Its truth channel has the attitude.
class Inclinometer final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Roll and pitch from the specific force, so it errs while accelerated.";
  static constexpr bool measures_alone = true;
  static constexpr double default_rate_hz = 10;
  struct Params {
    bool ideal = false;
    double time_constant_s = 0.3;
    sim::NoiseParams noise;  ///< of roll and of pitch, rad
    void read(sim::ParamReader& in);
  };

  Inclinometer(const Params& params, const sim::DeviceContext& context);
  void change(const Params& params);
  auto noises() { return std::tie(noise_); }
  void measure(const sim::SenseContext& context) override;
  void displaced() override {
    strapdown_.restart();
    filter_.restart();
  }
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override { archive(strapdown_, filter_, noise_, reading_); }
  const Tilt& reading() const { return reading_; }

 private:
  bool ideal_;
  Strapdown strapdown_;
  LowPass filter_;
  sim::NoiseOf<&Params::noise> noise_;
  Tilt reading_;
};

}  // namespace devices
