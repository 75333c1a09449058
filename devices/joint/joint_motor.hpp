// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/joint/joint_power.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

/// Motor that drives one joint of the vehicle at a commanded velocity, with limited velocity and force.
class JointMotor final : public sim::Actuator {
 public:
  static constexpr const char* meaning = "Motor on one hinge or slider, commanded by velocity.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr bool acts_alone = true;
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::coast};
  static constexpr const char* fixed_keys[] = {"joint"};
  struct Params {
    std::string joint;
    double max_velocity = 10;  ///< rad/s, or m/s of a slider
    double max_force = 10;     ///< N m, or N of a slider
    MotorPower power;
    void read(sim::ParamReader& in);
  };

  JointMotor(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context) override;
  /// Applies a safe state.  stop: it brakes; coast: it turns freely.
  void make_safe(sim::SafeState safe) override;
  void change(const Params& params);
  double power_W() const override { return params_.power.of_motor(joint_, 0, params_.max_force); }
  void visit_state(sim::StateArchive& archive) override { archive(velocity_, coasting_); }
  /// Commands a velocity, which is limited.
  void set_velocity(double velocity);
  double velocity() const { return velocity_; }

 private:
  Params params_;
  sim::Joint& joint_;
  const sim::Vehicle& vehicle_;
  double velocity_ = 0;
  bool coasting_ = false;
};

/// Receives shoal.joint_command_t.
class JointMotorController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.joint_command_t";
  explicit JointMotorController(JointMotor& motor) : motor_(motor) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  JointMotor& motor_;
};

}  // namespace devices
