// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/physics/joint.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Wheel encoder: counts ticks of the rotation of joints, so that a slipping wheel is counted like a rolling one.
class WheelEncoder final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Ticks of wheels, counted from the turning of their joints.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr double default_rate_hz = 50;
  static constexpr const char* fixed_keys[] = {"joints", "ticks_per_revolution"};
  struct Params {
    std::vector<std::string> joints;
    int ticks_per_revolution = 1024;
    double missed_ticks = 0;
    sim::NoiseParams noise;  ///< error of the rotation of each wheel between two samples, rad
    void read(sim::ParamReader& in);
  };
  struct Wheel {
    std::string name;
    const sim::Joint* joint;
    int axis;  ///< last axis of the joint; the wheel axis of a hinge2
  };

  WheelEncoder(const Params& params, const sim::DeviceContext& context);
  /// Measures the truth: every tick, and the rate of the joint.
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  /// Applies changed errors; joints and ticks are kept.
  void change(const Params& params) { params_.missed_ticks = params.missed_ticks; }
  auto noises() { return std::tie(noise_); }
  void visit_state(sim::StateArchive& archive) override;
  const std::vector<Wheel>& wheels() const { return wheels_; }
  const std::vector<std::int64_t>& ticks() const { return ticks_; }
  const std::vector<double>& rates_radps() const { return rates_radps_; }

 private:
  std::int64_t missed_of(std::int64_t passed, sim::Random& random) const;
  std::int64_t ticks_at(double angle_rad) const;

  Params params_;
  std::vector<Wheel> wheels_;
  sim::NoiseOf<&Params::noise> noise_;
  std::vector<double> angles_rad_;     ///< true, at the last sample
  std::vector<double> believed_rad_;   ///< angle with noise
  std::vector<std::int64_t> passed_;   ///< ticks of the angle with noise
  std::vector<std::int64_t> counted_;  ///< counted ones of those ticks
  std::vector<std::int64_t> ticks_;    ///< the reading
  std::vector<double> rates_radps_;    ///< the reading
};

}  // namespace devices
