// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/physics/joint.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Sensor of positions, velocities and efforts of joints.  A joint with two axes is listed twice, as NAME and NAME/1; a
/// ball joint with a motor three times.
class JointState final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Positions, velocities and efforts of the vehicle's joints.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr double default_rate_hz = 50;
  static constexpr const char* fixed_keys[] = {"joints", "effort"};
  struct Params {
    std::vector<std::string> joints;
    bool effort = true;
    sim::NoiseParams position_noise;
    sim::NoiseParams velocity_noise;
    sim::NoiseParams effort_noise;
    void read(sim::ParamReader& in);
  };
  struct Axis {
    std::string name;
    sim::Joint* joint;
    int axis;
  };

  JointState(const Params& params, const sim::DeviceContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  /// Returns the noises, which can change during a run, unlike the joints.
  auto noises() { return std::tie(position_noise_, velocity_noise_, effort_noise_); }
  void visit_state(sim::StateArchive& archive) override;

  // Readings with the signs of the joints; rad, rad/s, N m, or m, m/s, N of a slider.
  const std::vector<Axis>& axes() const { return axes_; }
  const std::vector<double>& positions() const { return positions_; }
  const std::vector<double>& velocities() const { return velocities_; }
  const std::vector<double>& efforts() const { return efforts_; }

 private:
  std::vector<Axis> axes_;
  sim::NoiseOf<&Params::position_noise> position_noise_;
  sim::NoiseOf<&Params::velocity_noise> velocity_noise_;
  sim::NoiseOf<&Params::effort_noise> effort_noise_;
  std::vector<double> positions_, velocities_, efforts_;
};

}  // namespace devices
