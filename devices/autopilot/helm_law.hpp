// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "devices/autopilot/autopilot_control.hpp"
#include "devices/autopilot/thrust_allocation.hpp"
#include "sim/base/math.hpp"

namespace devices {

/// How a craft moves now.  S: its frame, x forward, y left, z up.
struct CraftMotion {
  sim::Pose X_WS = sim::Pose::Identity();
  sim::Vector3d v_WS_W = sim::Vector3d::Zero();  ///< over ground
  sim::Vector3d v_S = sim::Vector3d::Zero();     ///< through the water
  sim::Vector3d w_S = sim::Vector3d::Zero();
};

/// What it is to do.
struct Setpoint {
  double speed_mps = 0;  ///< through the water, ahead
  double heading_rad = 0;
  double height_m = 0;                         ///< of its frame in the world
  std::optional<Eigen::Vector2d> station_m{};  ///< to stay over; speed is not looked at then
  void visit_state(sim::StateArchive& archive) { archive(speed_mps, heading_rad, height_m, station_m); }
};

/// What the actuators are asked for.
struct Demand {
  Wrench wrench = Wrench::Zero();                     ///< in S, N and N m
  double speed_mps = 0, heading_rad = 0;              ///< what it wants at this moment
  double heading_error_rad = 0, speed_error_mps = 0;  ///< wanted less true
};

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

/// How a craft is moved.
struct CraftAbilities {
  Wrench mass = Wrench::Ones();  ///< with added mass, kg and kg m^2
  bool fins = false;             ///< it climbs by its pitch
  bool sideways = false;         ///< thrusters push it sideways
  bool heaves = false;           ///< and up and down
};

/// Which actuators were at their limits in the last step.
struct Limited {
  bool thrusters = false;
  bool fins = false;
  bool any() const { return thrusters || fins; }
  void visit_state(sim::StateArchive& archive) { archive(thrusters, fins); }
};

/// From set values to forces and torques.
class HelmLaw {
 public:
  HelmLaw(const HelmGains& gains, const CraftAbilities& craft);

  Demand step(const CraftMotion& motion, const Setpoint& desired, double dt_s, const Limited& limited);
  /// Forgets the sums of errors.
  void reset();
  void visit_state(sim::StateArchive& archive) {
    archive(heading_, depth_, roll_, pitch_, east_, north_, speed_, climb_sum_rad_, drift_sum_mps_);
  }

 private:
  sim::Vector3d hold_station_sideways(const CraftMotion& motion, const Eigen::Vector2d& station, double dt_s,
                                      bool frozen);
  void hold_station_ahead(const CraftMotion& motion, const Eigen::Vector2d& station, double dt_s, bool frozen,
                          Demand& demand);
  double pitch_for(const CraftMotion& motion, double height_m, double dt_s, bool frozen);

  HelmGains gains_;
  CraftAbilities craft_;
  AxisHold heading_, depth_, roll_, pitch_, east_, north_;
  RateHold speed_;
  double climb_sum_rad_ = 0;
  Eigen::Vector2d drift_sum_mps_ = Eigen::Vector2d::Zero();
};

}  // namespace devices
