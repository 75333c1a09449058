// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/autopilot/autopilot_route.hpp"
#include "devices/autopilot/helm_law.hpp"

namespace devices {

/// Mode of an autopilot.
enum class AutopilotMode { off = 0, hold = 1, waypoints = 2, station = 3, circle = 4 };

inline constexpr sim::ChoiceWords<AutopilotMode> autopilot_mode_words{{"off", AutopilotMode::off},
                                                                      {"hold", AutopilotMode::hold},
                                                                      {"waypoints", AutopilotMode::waypoints},
                                                                      {"station", AutopilotMode::station},
                                                                      {"circle", AutopilotMode::circle}};

/// Behavior after the last waypoint.
enum class AtEnd { station, stop, hold, circle };

/// Section `hold:`, setpoints at the start; unset: the initial values.
struct HoldParams {
  double speed_mps = 0;
  std::optional<double> heading_deg;
  std::optional<double> depth_m;
  std::optional<double> altitude_m;
  void read(sim::ParamReader& in);
};

/// Section `station:`, position to keep.
struct StationParams {
  std::optional<Eigen::Vector2d> place_m;  ///< unset: initial position
  void read(sim::ParamReader& in);
};

/// Keys of an autopilot.
struct AutopilotParams {
  std::optional<AutopilotMode> mode;  ///< unset: waypoints when there are any, else hold
  std::vector<std::string> thrusters;
  std::vector<std::string> fins;
  std::string helm;
  std::vector<double> thruster_weights;
  std::vector<std::string> axes;
  HoldParams hold;
  StationParams station;
  std::vector<Waypoint> waypoints;
  std::optional<Lawnmower> lawnmower;
  bool loop = false;
  AtEnd at_end = AtEnd::station;
  double circle_radius_m = 15;
  GuidanceParams guidance;
  HelmGains gains;
  double altitude_range_m = 200;
  void read(sim::ParamReader& in);

  /// Returns the waypoints, or those of the lawnmower.
  std::vector<Waypoint> route() const;
  /// Returns the mode at the start.
  AutopilotMode first_mode() const;

 private:
  void check(sim::ParamReader& in) const;
};

}  // namespace devices
