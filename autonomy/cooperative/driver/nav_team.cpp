// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/nav_team.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "devices/comms/acoustic_modem.hpp"
#include "devices/inertial/ahrs.hpp"
#include "devices/inertial/compass.hpp"
#include "devices/navigation/dvl.hpp"
#include "devices/navigation/gps.hpp"
#include "devices/navigation/pressure.hpp"
#include "devices/sound_positioning/usbl.hpp"
#include "experiment/score/bound/vehicle_errors.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/medium/medium.hpp"
#include "sim/world_file/load_world.hpp"

namespace navigation {

namespace {

constexpr double pascals_per_m = 10'055;  ///< of sea water
/// A craft without a DVL reports its velocity with each fix; in between it accelerates.
constexpr double craft_density = 0.1;

double square_of(double x) {
  return x * x;
}

template <class Model>
const typename Model::Params& params_of(const sim::DeviceConfig& device) {
  return static_cast<const sim::detail::ParamsOf<typename Model::Params>&>(*device.params).params;
}

double constant_part(const sim::NoiseParams& noise) {
  return std::hypot(noise.bias, noise.bias_std);
}

double white_part(const sim::NoiseParams& noise) {
  return std::hypot(noise.gaussian_std, noise.uniform_half_width / std::sqrt(3.0));
}

/// Spectral density of a slow error, as if it were white.
double slow_density(const sim::NoiseParams& noise) {
  return 2 * square_of(noise.gauss_markov_std) * noise.gauss_markov_time_s;
}

void add_heading(const sim::NoiseParams& noise, NavVehicle& vehicle) {
  vehicle.errors.heading_bias_rad = constant_part(noise);
  vehicle.errors.heading_walk_radprts = noise.random_walk_std;
  vehicle.errors.slow_heading_rad = noise.gauss_markov_std;
  vehicle.errors.slow_heading_time_s = noise.gauss_markov_time_s;
  vehicle.heading_white_rad = white_part(noise);
}

void add_dvl(const devices::Dvl::Params& dvl, double rate_hz, NavVehicle& vehicle) {
  // Four beams at the angle a: the least-squares solution has the variances 1 / (2 sin^2 a), twice, and 1 / (4 cos^2
  // a).
  const double horizontal = 1 / (2 * square_of(std::sin(dvl.beam_angle_rad)));
  const double vertical = 1 / (4 * square_of(std::cos(dvl.beam_angle_rad)));
  vehicle.velocity_share = horizontal / (2 * horizontal + vertical);
  vehicle.errors.speed_scale = std::hypot(dvl.scale_std, dvl.beam_noise.scale_error, dvl.velocity_noise.scale_error);
  vehicle.velocity_density = square_of(white_part(dvl.velocity_noise)) / std::max(rate_hz, 1e-3) +
                             slow_density(dvl.velocity_noise) + horizontal * slow_density(dvl.beam_noise);
}

void add_gps(const devices::Gps::Params& gps, NavVehicle& vehicle) {
  vehicle.fix_std_m = std::max(white_part(gps.horizontal_noise), 0.01);
  vehicle.errors.slow_fix_m = std::hypot(gps.horizontal_noise.gauss_markov_std, constant_part(gps.horizontal_noise));
  vehicle.errors.slow_fix_time_s =
      gps.horizontal_noise.gauss_markov_std > 0 ? gps.horizontal_noise.gauss_markov_time_s : 1e6;
}

void add_usbl(const devices::Usbl::Params& usbl, NavVehicle& vehicle) {
  vehicle.usbl_errors.range_std_m = white_part(usbl.range_noise);
  vehicle.usbl_errors.across_std_rad = white_part(usbl.azimuth_noise);
  vehicle.usbl_errors.elevation_std_rad = white_part(usbl.elevation_noise);
  vehicle.usbl_errors.heading_std_rad = vehicle.heading_white_rad;
}

/// A craft without DVL moves by the velocity of its fixes, which its heading does not turn: the lasting errors of the
/// heading are in its relative measurements only.
void without_heading_states(NavVehicle& vehicle) {
  vehicle.usbl_errors.heading_std_rad =
      std::hypot(vehicle.usbl_errors.heading_std_rad, vehicle.errors.heading_bias_rad, vehicle.errors.slow_heading_rad);
  vehicle.errors.heading_bias_rad = vehicle.errors.heading_walk_radprts = vehicle.errors.slow_heading_rad = 0;
}

void add_clock(const sim::ClockConfig& clock, NavVehicle& vehicle) {
  vehicle.errors.clock_s = std::hypot(clock.offset_s, clock.offset_std_s);
  // A flicker floor f is a deviation of the frequency of about f; water is up to 10 degrees from the reference.
  vehicle.errors.clock_drift = std::hypot(1e-6 * std::hypot(clock.drift_ppm, clock.drift_std_ppm), clock.flicker_floor,
                                          1e-5 * clock.temperature_ppm_per_C);
  vehicle.errors.clock_walk_srts = clock.white_fm;
}

NavVehicle vehicle_of(const sim::WorldConfig& world, const sim::VehicleInstance& instance) {
  NavVehicle vehicle;
  vehicle.name = instance.name;
  const sim::VehicleConfig& config = *instance.config;
  bool disciplined = false;
  const devices::Usbl::Params* usbl = nullptr;
  for (const sim::DeviceConfig& device : config.devices) {
    const NavDevice nav{sim::device_channel(world.channels, instance.name, device, sim::ChannelKind::report),
                        device.X_BS()};
    if (device.type == "dvl" && !vehicle.dvl) {
      vehicle.dvl = nav;
      add_dvl(params_of<devices::Dvl>(device), device.rate_hz, vehicle);
    } else if (device.type == "ahrs" && !vehicle.ahrs) {
      vehicle.ahrs = nav;
      add_heading(params_of<devices::Ahrs>(device).heading_noise, vehicle);
    } else if (device.type == "compass" && !vehicle.compass) {
      vehicle.compass = nav;
      if (!vehicle.ahrs) add_heading(params_of<devices::Compass>(device).heading_noise, vehicle);
    } else if (device.type == "pressure" && !vehicle.pressure) {
      vehicle.pressure = nav;
      vehicle.depth_std_m = white_part(params_of<devices::Pressure>(device).pressure_noise) / pascals_per_m;
    } else if (device.type == "gps" && !vehicle.gps) {
      vehicle.gps = nav;
      add_gps(params_of<devices::Gps>(device), vehicle);
      disciplined = params_of<devices::Gps>(device).disciplines_clock;
    } else if (device.type == "acoustic_modem" && !vehicle.modem) {
      vehicle.modem = nav;
      vehicle.modem_command = sim::device_channel(world.channels, instance.name, device, sim::ChannelKind::command);
      vehicle.synchronous_s = params_of<devices::AcousticModem>(device).synchronous_s;
    } else if (device.type == "usbl" && !vehicle.usbl) {
      vehicle.usbl = nav;
      usbl = &params_of<devices::Usbl>(device);
    } else if ((device.type == "autopilot" || device.type == "naive_drive") && vehicle.helm_command.empty()) {
      vehicle.helm_command = sim::device_channel(world.channels, instance.name, device, sim::ChannelKind::command);
    }
  }
  if (!disciplined && !config.clock.perfect()) add_clock(config.clock, vehicle);
  vehicle.stamp_std_s = experiment::errors_of(config, world.physics.step_s).stamp_std_s();
  if (usbl != nullptr) add_usbl(*usbl, vehicle);
  if (!vehicle.dvl) {
    vehicle.velocity_density = craft_density;
    without_heading_states(vehicle);
  }
  return vehicle;
}

}  // namespace

NavTeam team_of(const sim::WorldConfig& world) {
  NavTeam team;
  const sim::Medium medium(world.medium, world.physics.gravity_mps2, static_cast<std::uint64_t>(world.run.seed));
  std::vector<const sim::VehicleConfig*> configs;
  for (const sim::VehicleInstance& instance : world.vehicles) configs.push_back(instance.config.get());
  for (const sim::VehicleInstance& instance : world.vehicles) {
    NavVehicle vehicle = vehicle_of(world, instance);
    if (!vehicle.modem) continue;
    vehicle.usbl_errors.hearing = experiment::usbl_hearing(*instance.config, configs, world.acoustics, medium);
    team.vehicles.push_back(std::move(vehicle));
  }
  if (team.vehicles.empty())
    throw std::invalid_argument("world '" + world.name + "' has no vehicle with an acoustic modem");
  team.sound = SoundRanges(medium);
  return team;
}

sim::WorldConfig world_of_text(const std::string& resolved_world) {
  sim::LoadOptions options;
  options.serial_ports = false;
  options.resolve = false;
  sim::Diagnostics diagnostics;
  sim::ConfigNode world = sim::parse_config_text(resolved_world, "sim.info", diagnostics);
  diagnostics.throw_if_any();
  // What happens in the run, and how it is scored, does not concern navigation.
  std::erase_if(world.entries, [](const sim::ConfigNode::Entry& entry) {
    static constexpr std::string_view others[] = {"actors", "bridges", "events",   "metrics",
                                                  "pass",   "plugins", "processes"};
    return std::find(std::begin(others), std::end(others), entry.key) != std::end(others);
  });
  return sim::load_world_tree(std::move(world), "sim.info", options).config;
}

NavTeam team_of_text(const std::string& resolved_world) {
  return team_of(world_of_text(resolved_world));
}

}  // namespace navigation
