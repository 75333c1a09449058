// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "devices/joint/joint_power.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

/// Motors and stops of the axes of a joint, set by messages at run time.
///
/// Each axis has a motor with a velocity and a maximum force, as in ODE: it applies the force that reaches that
/// velocity within a step, up to the maximum.  A velocity that cannot be reached thus gives a motor with constant
/// force.  A stop set beyond the present position pushes the joint back, at a rate that depends on the stiffness of its
/// stops.
class JointDrive final : public sim::Actuator {
 public:
  static constexpr const char* meaning =
      "Motors and stops of a ball, hinge, hinge2, slider or universal, set by messages.";
  static constexpr sim::SafeState safe_states[] = {sim::SafeState::stop, sim::SafeState::coast};
  static constexpr const char* fixed_keys[] = {"joint", "axes"};
  struct Params {
    std::string joint;
    std::vector<double> axes;  ///< 0 to 2; empty: all
    double max_velocity = 10;  ///< rad/s, or m/s of a slider
    double max_force = 10;     ///< N m, or N of a slider
    MotorPower power;
    void read(sim::ParamReader& in);
  };
  /// Settings of an axis.  NaN: unchanged.
  struct Settings {
    double velocity = std::numeric_limits<double>::quiet_NaN();
    double max_force = std::numeric_limits<double>::quiet_NaN();
    double low_stop = std::numeric_limits<double>::quiet_NaN();   ///< -infinity: none
    double high_stop = std::numeric_limits<double>::quiet_NaN();  ///< infinity: none
  };

  JointDrive(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context) override;
  /// Applies a safe state.  stop: the motors brake with maximum force; coast: they turn freely.  Stops are kept.
  void make_safe(sim::SafeState safe) override;
  void change(const Params& params);
  double power_W() const override;
  void visit_state(sim::StateArchive& archive) override;

  /// Changes the settings of one axis, or of all with -1.  Velocity and force are limited.  Throws std::runtime_error
  /// and changes nothing for an axis that does not exist, a negative force, and invalid stops.
  void set(int axis, const Settings& settings);

 private:
  struct Axis {
    int number;  ///< number of the axis of the joint
    double velocity = 0, max_force = 0;
    double low_stop = -std::numeric_limits<double>::infinity(), high_stop = std::numeric_limits<double>::infinity();
    bool has_stops = true;
    void visit_state(sim::StateArchive& archive) {
      archive(velocity, max_force);
      archive.not_only_finite(low_stop, high_stop);
    }
  };
  Axis with(Axis axis, const Settings& settings) const;
  void check_stops(const Axis& axis, const Settings& settings) const;

  Params params_;
  sim::Joint& joint_;
  const sim::Vehicle& vehicle_;
  std::vector<Axis> axes_;
  bool coasting_ = false;
};

/// Receives shoal.joint_settings_t.
class JointDriveController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.joint_settings_t";
  explicit JointDriveController(JointDrive& drive) : drive_(drive) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  JointDrive& drive_;
};

}  // namespace devices
