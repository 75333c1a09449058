// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "autonomy/cooperative/driver/sound_ranges.hpp"
#include "autonomy/cooperative/estimator/setup.hpp"
#include "experiment/score/bound/usbl_errors.hpp"
#include "sim/base/math.hpp"
#include "sim/world_file/world_config.hpp"

namespace navigation {

/// Device of a vehicle whose reports navigation uses.
struct NavDevice {
  std::string channel;  ///< of its reports
  sim::Pose X_BS = sim::Pose::Identity();
};

/// What navigation knows of a land vehicle in addition, from its vehicle file and its place in the world.
struct LandVehicle {
  sim::Pose X_WV = sim::Pose::Identity();  ///< at the start, from which odometry counts
  NavDevice odometry;
  std::optional<NavDevice> swarm;  ///< of type swarm_position
  double along_density = 0;        ///< white noise of the distance, m^2/s
  double across_density = 0;       ///< white noise of the displacement sideways, m^2/s
  double seen_std_m = 0.01;        ///< white error of each coordinate of another vehicle
  /// White errors of range and bearing; unset: those of the coordinates.
  std::optional<double> range_std_m, bearing_std_rad;
};

/// What navigation knows of a vehicle, from its vehicle file.  USBL needs a heading.  The modem of a land vehicle is a
/// radio.
struct NavVehicle {
  std::string name;
  DeviceErrors errors;
  std::optional<NavDevice> dvl, ahrs, compass, pressure, gps, modem, usbl;
  std::string modem_command;     ///< channel
  std::string helm_command;      ///< channel of its autopilot; empty: it has none
  double synchronous_s = 0;      ///< the modem transmits at multiples of this only; 0: at once
  double velocity_share = 0;     ///< variance of a horizontal component over the square of the DVL's `fom_mps`
  double velocity_density = 0;   ///< further white noise of the velocity over ground, m^2/s
  double heading_white_rad = 0;  ///< white error of each report of the heading
  double fix_std_m = 0;          ///< white error of a fix; 0: as reported
  double stamp_std_s = 0;        ///< error of a stamp, by the resolution of the clock
  double depth_std_m = 0;        ///< white error of the depth, by pressure
  /// White errors of USBL.  That of the heading has its other parts, too, in a vehicle without DVL, where they are
  /// not states.
  experiment::UsblErrors usbl_errors;
  std::optional<LandVehicle> land;  ///< on land only
};

/// Vehicles that navigate together, in the order of the world file: those with an acoustic modem, on land those with
/// odometry.
struct NavTeam {
  std::vector<NavVehicle> vehicles;
  SoundRanges sound;

  /// Returns the index of a vehicle; nothing when it is not in the team.
  std::optional<int> index_of(const std::string& name) const { return index_of_vehicle(vehicles, name); }
  std::vector<Member> members() const { return members_of(vehicles); }
  bool is_on_land() const { return !vehicles.empty() && vehicles.front().land; }
};

/// Returns the team of a marine world.  Errors of devices that are known for certain (`bias`, `scale_error`) count as
/// unknown ones of that size.  Throws std::invalid_argument when no vehicle has an acoustic modem.
NavTeam team_of(const sim::WorldConfig& world);
/// Reads a world given as text, such as sim_info_t::resolved_config, without what happens in it.  Throws
/// sim::ConfigError.
sim::WorldConfig world_of_text(const std::string& resolved_world);
/// Returns the team of such a world.  Throws sim::ConfigError, too.
NavTeam team_of_text(const std::string& resolved_world);

}  // namespace navigation
