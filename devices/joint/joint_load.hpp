// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/physics/joint.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Force and torque through a joint, as measured by a load cell or force-torque sensor: the wrench that the joint
/// applies to its second body (or to the only movable body), with the torque about the anchor of the joint.
class JointLoad final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Force and torque transmitted by a joint, about its anchor.";
  static constexpr const char* without_effect[] = {"position_m"};
  static constexpr double default_rate_hz = 100;
  static constexpr const char* fixed_keys[] = {"joint"};
  enum class Frame { sensor, body, world };
  struct Params {
    std::string joint;
    Frame frame = Frame::sensor;
    sim::NoiseParams force_noise;
    sim::NoiseParams torque_noise;
    void read(sim::ParamReader& in);
  };

  JointLoad(const Params& params, const sim::DeviceContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  /// Applies changed errors and frame; the joint is kept.
  void change(const Params& params) { params_.frame = params.frame; }
  auto noises() { return std::tie(force_noise_, torque_noise_); }
  void visit_state(sim::StateArchive& archive) override { archive(force_noise_, torque_noise_, force_N_, torque_Nm_); }
  /// Return the reading in the configured frame.
  const sim::Vector3d& force_N() const { return force_N_; }
  const sim::Vector3d& torque_Nm() const { return torque_Nm_; }

 private:
  sim::Matrix3d R_FW(const sim::SenseContext& context) const;

  Params params_;
  const sim::Joint& joint_;
  const sim::Body& body_;
  sim::NoiseOf<&Params::force_noise> force_noise_;
  sim::NoiseOf<&Params::torque_noise> torque_noise_;
  sim::Vector3d force_N_ = sim::Vector3d::Zero();
  sim::Vector3d torque_Nm_ = sim::Vector3d::Zero();
};

}  // namespace devices
