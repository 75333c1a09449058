// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/common/actuator_lag.hpp"
#include "sim/physics/body.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Force and torque on the body in the device frame, the force at its origin, in water and in air.  Uses: thrusters
/// modeled by another program, a tow, a push in a test.
class BodyWrench final : public sim::Actuator {
 public:
  static constexpr const char* meaning = "Force and torque on the body in the device's frame, at its origin.";
  static constexpr bool acts_alone = true;
  struct Params {
    sim::Vector3d force_max_N = sim::Vector3d::Constant(1000);
    sim::Vector3d torque_max_Nm = sim::Vector3d::Constant(1000);
    double lag_s = 0;
    void read(sim::ParamReader& in);
  };

  BodyWrench(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context) override;
  /// stop: zero wrench.
  void make_safe(sim::SafeState) override { set_wrench(sim::Vector3d::Zero(), sim::Vector3d::Zero()); }
  void change(const Params& params);
  void visit_state(sim::StateArchive& archive) override {
    archive(desired_force_N_, desired_torque_Nm_, force_N_, torque_Nm_);
  }

  /// Sets the wrench in the device frame; each axis is clamped to its limit.
  void set_wrench(const sim::Vector3d& force_N, const sim::Vector3d& torque_Nm);

 private:
  Params params_;
  const sim::World& world_;
  sim::Body& body_;
  sim::Vector3d p_BD_;
  sim::Matrix3d R_BD_;
  sim::Vector3d desired_force_N_ = sim::Vector3d::Zero(), desired_torque_Nm_ = sim::Vector3d::Zero();
  sim::Vector3d force_N_ = sim::Vector3d::Zero(), torque_Nm_ = sim::Vector3d::Zero();
};

/// Receives shoal.wrench_t.
class BodyWrenchController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.wrench_t";
  explicit BodyWrenchController(BodyWrench& wrench) : wrench_(wrench) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  BodyWrench& wrench_;
};

}  // namespace devices
