// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "bridges/moos/vehicle_commands.hpp"
#include "bridges/moos/vehicle_navigation.hpp"
#include "shoal/client.hpp"
#include "sim/base/geodesy.hpp"
#include "tools/command_line/declared_options.hpp"

namespace autonomy {

/// The devices of a vehicle that a bridge to another autonomy system uses, by their names; empty: none.
struct BridgedVehicle {
  std::string name;
  std::string gps = "gps", ahrs = "ahrs", compass, pressure = "pressure", altimeter = "altimeter", dvl = "dvl";
  std::string estimate, autopilot = "autopilot", port_thruster, starboard_thruster;
  double full_ahead = 1;
  bool truth = false;

  void declare(command_line::DeclaredOptions& options);
  bridges::VehicleNavigation::Position position() const;
  bridges::ThrusterPair thrusters() const;
  /// Returns the channel of commands to a device; empty for none.
  std::string command_channel(const std::string& device) const;
  /// Keeps `navigation` up to date, and calls `changed` after each report with the fields that it has set.
  void subscribe(shoal::Client& client, bridges::VehicleNavigation& navigation,
                 const std::function<void(bridges::VehicleNavigation::Fields)>& changed) const;
};

/// Returns the origin of a world from its resolved file.  Throws sim::ConfigError.
sim::GeodeticPosition origin_of_world(const std::string& resolved_config);

}  // namespace autonomy
