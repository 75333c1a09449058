// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "autonomy/cooperative/driver/nav_team.hpp"
#include "sim/base/math.hpp"
#include "sim/world_file/world_config.hpp"

namespace navigation {

/// What navigation knows of a land vehicle, from its vehicle file and its place in the world.
struct LandVehicle {
  std::string name;
  sim::Pose X_WV = sim::Pose::Identity();  ///< at the start, from which odometry counts
  DeviceErrors errors;
  NavDevice odometry;
  std::optional<NavDevice> swarm, gps, modem;  ///< `swarm`: of type swarm_position
  std::string modem_command;                   ///< channel
  double along_density = 0;                    ///< white noise of the distance, m^2/s
  double across_density = 0;                   ///< white noise of the displacement sideways, m^2/s
  double fix_std_m = 0.01;                     ///< white error of each coordinate of a fix
  double seen_std_m = 0.01;                    ///< white error of each coordinate of another vehicle
  /// White errors of range and bearing; unset: those of the coordinates.
  std::optional<double> range_std_m, bearing_std_rad;
};

/// Land vehicles that navigate together: those with odometry, in the order of the world file.
struct LandTeam {
  static constexpr double start_std_m = 0.1;  ///< of east and north at the start
  static constexpr double start_heading_std_rad = 0.03;

  std::vector<LandVehicle> vehicles;
  std::optional<int> index_of(const std::string& name) const { return index_of_vehicle(vehicles, name); }
  std::vector<Member> members() const { return members_of(vehicles); }
};

/// Whether a world is one of land vehicles: no acoustic modem.
bool is_on_land(const sim::WorldConfig& world);

/// Returns the team of a world, with the errors that the metric `bound` uses.  In a world without any devices,
/// an imported data set of MR.CLAM, all vehicles have the errors of its robots.  Throws std::invalid_argument when no
/// vehicle has odometry.
LandTeam land_team_of(const sim::WorldConfig& world);

}  // namespace navigation
