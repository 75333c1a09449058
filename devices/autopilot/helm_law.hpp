// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "devices/autopilot/autopilot_control.hpp"
#include "devices/autopilot/thrust_allocation.hpp"
#include "sim/base/math.hpp"

namespace devices {

/// Motion of a craft.  S: its frame, x forward, y left, z up.
struct CraftMotion {
  sim::Pose X_WS = sim::Pose::Identity();
  sim::Vector3d v_WS_W = sim::Vector3d::Zero();  ///< velocity over ground
  sim::Vector3d v_S = sim::Vector3d::Zero();     ///< velocity through the water
  sim::Vector3d w_S = sim::Vector3d::Zero();     ///< angular velocity
};

/// Desired motion of a craft.
struct Setpoint {
  double speed_mps = 0;  ///< forward speed through the water
  double heading_rad = 0;
  double height_m = 0;                         ///< height of its frame in the world
  std::optional<Eigen::Vector2d> station_m{};  ///< position to keep; replaces the speed
  void visit_state(sim::StateArchive& archive) { archive(speed_mps, heading_rad, height_m, station_m); }
};

/// Output of the control law.
struct Demand {
  Wrench wrench = Wrench::Zero();                     ///< commanded wrench in S, N and N m
  double speed_mps = 0, heading_rad = 0;              ///< setpoints of this step
  double heading_error_rad = 0, speed_error_mps = 0;  ///< setpoint minus actual value
};

/// Gains of the control law.
struct HelmGains {
  HoldGains heading{1.5, 1, 0.4, 0.05};
  HoldGains depth{1, 1, 0.4, 0.1};
  HoldGains attitude{1.2, 1, 0.5, 0.1};
  HoldGains position{1, 1, 0.5, 0.1};
  double speed_bandwidth_radps = 1;
  double speed_integral = 0.4;
  double climb_gain_per_s = 0.3;
  double steerage_mps = 1.2;
  double pitch_max_rad = sim::degrees_to_radians(25);
  void read(sim::ParamReader& in);
};

/// Mass and actuators of a craft.
struct CraftAbilities {
  Wrench mass = Wrench::Ones();  ///< including added mass, kg and kg m^2
  bool fins = false;             ///< depth is controlled by pitch, with fins
  bool sideways = false;         ///< thrusters control sway
  bool heaves = false;           ///< thrusters control heave
};

/// Control law from setpoints to forces and torques.
class HelmLaw {
 public:
  HelmLaw(const HelmGains& gains, const CraftAbilities& craft);

  /// Returns the wrench and setpoints for one control period of `dt_s`.  `given`: wrench of the actuators since the
  /// last step, in S.
  Demand step(const CraftMotion& motion, const Setpoint& desired, double dt_s, const Wrench& given);
  /// Resets the estimates of disturbances.
  void reset();
  void visit_state(sim::StateArchive& archive) {
    archive(heading_, depth_, roll_, pitch_, east_, north_, speed_, climb_sum_rad_, drift_mps_);
  }

 private:
  void hold_station_ahead(const CraftMotion& motion, const Eigen::Vector2d& station, Demand& demand) const;
  double pitch_for(const CraftMotion& motion, double height_m, double dt_s);

  HelmGains gains_;
  CraftAbilities craft_;
  AxisHold heading_, depth_, roll_, pitch_, east_, north_;
  RateHold speed_;
  double climb_sum_rad_ = 0;
  Eigen::Vector2d drift_mps_ = Eigen::Vector2d::Zero();  // velocity over ground without the speed ahead, smoothed
};

}  // namespace devices
