// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/autopilot/autopilot_config.hpp"
#include "devices/marine/thruster_command.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

/// Returns the coefficients of the body of a device; null: it has none.
const sim::HydrodynamicsConfig* hydrodynamics_of(const sim::DeviceContext& context);

/// Actuators of an autopilot, with the geometry and thrust curves from the vehicle file.
class AutopilotActuators {
 public:
  /// Throws ConfigError for unknown thrusters or fins, and for axes that they cannot control.
  AutopilotActuators(const AutopilotParams& params, const sim::DeviceContext& context);

  /// Returns mass and controllable axes of the craft.
  CraftAbilities abilities() const;
  /// Returns true when the thrusters control an axis of the wrench.
  bool gives(int axis) const { return allocation_ && allocation_->gives(axis); }
  /// Part of a wrench that the actuators give.
  struct Given {
    Wrench wrench = Wrench::Zero();  ///< in the frame of the body, N and N m
    bool saturated = false;          ///< it is not the wrench demanded
    void visit_state(sim::StateArchive& archive) { archive(wrench, saturated); }
  };
  /// Computes the commands for a wrench at a velocity through the water.  Returns what they give.
  Given share(const Wrench& wrench, const sim::Vector3d& v_B, double density_kgpm3);
  /// Publishes the commands computed by share().
  void publish(sim::Time now);

 private:
  /// Actuator by name, with its last command.
  struct Driven {
    std::string name;
    double command = 0;
    std::unique_ptr<sim::OpenChannel> channel{};  ///< opened by the first command
  };
  /// Thruster with its thrust curve and axis.
  struct Propeller {
    Driven device;
    ThrusterCommand curve;
    sim::Vector3d axis_B;
  };
  /// Fin with its limit.
  struct Plane {
    Driven device;
    double limit_rad;
  };
  void add_thrusters(const AutopilotParams& params, const sim::DeviceContext& context);
  void add_fins(const AutopilotParams& params, const sim::DeviceContext& context);
  void publish(Driven& device, sim::Time now);

  sim::Vehicle& vehicle_;
  std::int64_t epoch_us_;
  Wrench mass_;
  std::vector<Propeller> propellers_;
  std::vector<Plane> planes_;
  std::optional<ThrustAllocation> allocation_;
  Eigen::MatrixXd fin_torques_;  // pitch and yaw x fins: N m per rad at 1 m/s
  Eigen::MatrixXd fin_angles_;   // fins x torque: rad per N m at 1 m/s
  Eigen::VectorXd forces_N_;
  sim::Bytes payload_;
};

}  // namespace devices
