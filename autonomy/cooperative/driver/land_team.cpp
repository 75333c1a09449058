// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/land_team.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiment/score/bound/vehicle_errors.hpp"

namespace navigation {

namespace {

/// Turns of a vehicle, as a random walk of the heading after 1 s: a right angle in half a minute.  Estimators have no
/// state for the relative error of turns, so that it is a random walk for them.
constexpr double usual_turns_radprts = 0.3;
/// Without its own correlation time an error of fixes is constant.
constexpr double constant_time_s = 1e6;
/// Least white error of a fix or a relative measurement.
constexpr double min_white_m = 0.01;

void set_errors(const experiment::VehicleErrors& errors, NavVehicle& vehicle) {
  vehicle.errors.heading_bias_rad = land_start_heading_std_rad;
  vehicle.errors.heading_walk_radprts =
      std::hypot(errors.turn_noise_radprts, errors.turn_scale_std * usual_turns_radprts);
  vehicle.errors.speed_scale = errors.speed_scale_std;
  vehicle.land->along_density = errors.along_noise_mprts * errors.along_noise_mprts;
  if (errors.sightings) vehicle.land->seen_std_m = std::max(errors.sightings->white_std_m, min_white_m);
  if (!errors.gps) return;
  vehicle.fix_std_m = std::max(errors.gps->position.white_std, min_white_m);
  for (const experiment::SlowError& slow : errors.gps->position.slow) {
    vehicle.errors.slow_fix_m = std::hypot(vehicle.errors.slow_fix_m, slow.initial_std);
    vehicle.errors.slow_fix_time_s = slow.time_s > 0 ? slow.time_s : constant_time_s;
  }
}

/// Robots of MR.CLAM (Leung, Halpern, Barfoot and Liu, IJRR 30(8), 2011): their velocities are commands.  Larger than
/// the median errors, because a few per cent are far larger.  Wheels do not slide sideways: 3 mm in 1 s there.
void set_data_set_errors(NavVehicle& vehicle) {
  vehicle.errors.heading_bias_rad = land_start_heading_std_rad;
  vehicle.errors.heading_walk_radprts = 0.06;
  vehicle.land->along_density = 0.06 * 0.06;
  vehicle.land->across_density = 0.003 * 0.003;
  vehicle.land->range_std_m = 0.15;
  vehicle.land->bearing_std_rad = 0.05;
}

/// Whether a world is an imported data set: no vehicle has a device.
bool is_data_set(const sim::WorldConfig& world) {
  return std::all_of(world.vehicles.begin(), world.vehicles.end(),
                     [](const sim::VehicleInstance& instance) { return instance.config->devices.empty(); });
}

std::optional<NavVehicle> land_vehicle_of(const sim::WorldConfig& world, const sim::VehicleInstance& instance) {
  NavVehicle vehicle;
  vehicle.name = instance.name;
  vehicle.land.emplace().X_WV = instance.X_WV;
  const sim::VehicleConfig& config = *instance.config;
  if (is_data_set(world)) {
    vehicle.land->odometry.channel = instance.name + ".odometry";
    vehicle.land->swarm = NavDevice{instance.name + ".swarm_position"};
    set_data_set_errors(vehicle);
    return vehicle;
  }
  for (const sim::DeviceConfig& device : config.devices) {
    const NavDevice nav{sim::device_channel(world.channels, instance.name, device, sim::ChannelKind::report),
                        device.X_BS()};
    if (device.type == "odometry" && vehicle.land->odometry.channel.empty()) {
      vehicle.land->odometry = nav;
    } else if (device.type == "swarm_position" && !vehicle.land->swarm) {
      vehicle.land->swarm = nav;
    } else if (device.type == "gps" && !vehicle.gps) {
      vehicle.gps = nav;
    } else if (device.type == "modem" && !vehicle.modem) {
      vehicle.modem = nav;
      vehicle.modem_command = sim::device_channel(world.channels, instance.name, device, sim::ChannelKind::command);
    }
  }
  if (vehicle.land->odometry.channel.empty()) return std::nullopt;
  set_errors(experiment::errors_of(config, world.physics.step_s), vehicle);
  return vehicle;
}

}  // namespace

bool is_on_land(const sim::WorldConfig& world) {
  return std::none_of(world.vehicles.begin(), world.vehicles.end(), [](const sim::VehicleInstance& instance) {
    const auto& devices = instance.config->devices;
    return std::any_of(devices.begin(), devices.end(),
                       [](const sim::DeviceConfig& device) { return device.type == "acoustic_modem"; });
  });
}

NavTeam land_team_of(const sim::WorldConfig& world) {
  NavTeam team;
  std::string others;
  for (const sim::VehicleInstance& instance : world.vehicles) {
    if (auto vehicle = land_vehicle_of(world, instance))
      team.vehicles.push_back(std::move(*vehicle));
    else
      others += (others.empty() ? "'" : ", '") + instance.name + "'";
  }
  if (team.vehicles.empty())
    throw std::invalid_argument("world '" + world.name + "' has no vehicle that shoal-nav can navigate: " +
                                (others.empty() ? "no vehicles" : "vehicle " + others) +
                                "; a vehicle must have an acoustic modem or odometry");
  return team;
}

}  // namespace navigation
