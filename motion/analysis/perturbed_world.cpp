// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/perturbed_world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "devices/motion/motion_player.hpp"
#include "sim/random/random.hpp"

namespace motion {

namespace {

template <typename Params>
const Params* params_of(const sim::DeviceConfig& device) {
  const auto* own = dynamic_cast<const sim::detail::ParamsOf<Params>*>(device.params.get());
  return own == nullptr ? nullptr : &own->params;
}

template <typename Params>
void set_params(sim::DeviceConfig& device, const Params& params) {
  auto own = std::make_shared<sim::detail::ParamsOf<Params>>();
  own->params = params;
  device.params = std::move(own);
}

bool has_player(const sim::VehicleConfig& vehicle) {
  return std::any_of(vehicle.devices.begin(), vehicle.devices.end(), [](const sim::DeviceConfig& one) {
    return params_of<devices::MotionPlayer::Params>(one) != nullptr;
  });
}

sim::VehicleInstance& instance_of(sim::WorldConfig& world, const std::string& vehicle) {
  return *std::find_if(world.vehicles.begin(), world.vehicles.end(),
                       [&](const sim::VehicleInstance& one) { return one.name == vehicle; });
}

void set_friction(sim::WorldConfig& world, sim::VehicleConfig& vehicle, double friction) {
  // The contacts of the world include those of its vehicles.
  if (vehicle.contacts.empty()) {
    for (sim::ContactConfig& contact : world.contacts) contact.friction = friction;
    if (world.contacts.empty()) world.contacts.emplace_back().friction = friction;
    return;
  }
  for (sim::ContactConfig& contact : vehicle.contacts) {
    for (sim::ContactConfig& of_world : world.contacts)
      if (of_world == contact) of_world.friction = friction;
    contact.friction = friction;
  }
}

void add_bumps(sim::WorldConfig& world, const sim::VehicleInstance& vehicle, const Perturbation& perturbation) {
  for (sim::ObjectConfig& object : world.objects)
    for (sim::PartConfig& part : object.bodies.front().parts) {  // that of a fixed object is the only one
      if (!object.fixed || part.shape != sim::PartShape::plane) continue;
      part.shape = sim::PartShape::terrain;
      sim::TerrainConfig& terrain = part.terrain.emplace();
      terrain.source = sim::TerrainConfig::Source::fractal;
      terrain.size_m = {8, 8};
      terrain.cell_m = 0.04;
      terrain.wavelength_m = 0.4;
      terrain.amplitude_m = perturbation.ground_m;
      terrain.seed = perturbation.ground_seed;
      terrain.place = part.place;
      terrain.directory = part.directory;
      sim::Vector3d middle_m = vehicle.X_WV.translation();
      middle_m.z() = 0;
      part.position_m += middle_m;
      return;
    }
}

}  // namespace

std::vector<Perturbation> drawn_perturbations(int count, std::uint64_t seed, const std::string& stream,
                                              const PerturbationRanges& ranges) {
  constexpr std::size_t quantities = 5;
  const auto n = static_cast<std::uint32_t>(count);
  sim::Random random(seed, stream);
  // For each quantity a permutation of the strata, and a place within each.
  std::array<std::vector<double>, quantities> shares;
  for (std::size_t q = 0; q < quantities; ++q) {
    random.begin_step(static_cast<std::int64_t>(q));
    std::vector<std::uint32_t> stratum(n);
    for (std::uint32_t i = 0; i < n; ++i) stratum[i] = i;
    for (std::uint32_t i = n; i > 1; --i) std::swap(stratum[i - 1], stratum[random.integer_below(i)]);
    for (std::uint32_t i = 0; i < n; ++i) shares[q].push_back((stratum[i] + random.uniform()) / n);
  }
  std::vector<Perturbation> drawn;
  const auto within = [](double low, double high, double share) { return low + share * (high - low); };
  for (std::size_t i = 0; i < n; ++i) {
    Perturbation one;
    one.friction = within(ranges.friction_low, ranges.friction_high, shares[0][i]);
    one.mass = within(1 - ranges.mass, 1 + ranges.mass, shares[1][i]);
    one.effort = within(ranges.effort_low, ranges.effort_high, shares[2][i]);
    one.lag_s = within(0, ranges.lag_s, shares[3][i]);
    one.ground_m = i % 2 == 1 ? within(0, ranges.ground_m, shares[4][i]) : 0;
    one.half_step = i % 4 == 2;
    one.ground_seed = static_cast<std::int64_t>(i) + 1;
    drawn.push_back(one);
  }
  return drawn;
}

double friction_of(const sim::WorldConfig& world, const std::string& vehicle) {
  const auto instance = std::find_if(world.vehicles.begin(), world.vehicles.end(),
                                     [&](const sim::VehicleInstance& one) { return one.name == vehicle; });
  if (instance != world.vehicles.end() && !instance->config->contacts.empty())
    return instance->config->contacts.front().friction;
  return world.contacts.empty() ? sim::ContactConfig{}.friction : world.contacts.front().friction;
}

std::string walking_vehicle(const sim::WorldConfig& world, const std::string& vehicle) {
  std::vector<std::string> found;
  for (const sim::VehicleInstance& one : world.vehicles)
    if (has_player(*one.config) && (vehicle.empty() || one.name == vehicle)) found.push_back(one.name);
  if (found.empty())
    throw sim::ConfigError({world.file + ": " +
                            (vehicle.empty() ? "no vehicle has a motion_player"
                                             : "there is no vehicle '" + vehicle + "' with a motion_player")});
  if (found.size() > 1)
    throw sim::ConfigError({world.file + ": several vehicles have a motion_player: name one of them with --vehicle"});
  return found.front();
}

sim::WorldConfig world_for_walks(const sim::WorldConfig& world) {
  sim::WorldConfig reduced = world;
  for (sim::VehicleInstance& instance : reduced.vehicles) {
    sim::VehicleConfig vehicle = *instance.config;
    // Sensors cost most of a step, and no motion depends on them.
    std::erase_if(vehicle.devices, [](const sim::DeviceConfig& device) {
      return params_of<devices::JointServo::Params>(device) == nullptr &&
             params_of<devices::JointGroup::Params>(device) == nullptr &&
             params_of<devices::MotionPlayer::Params>(device) == nullptr;
    });
    instance.config = std::make_shared<const sim::VehicleConfig>(std::move(vehicle));
  }
  reduced.events.clear();
  reduced.metrics.clear();
  reduced.pass.clear();
  reduced.processes.clear();
  return reduced;
}

sim::WorldConfig perturbed(sim::WorldConfig world, const std::string& vehicle, const Perturbation& perturbation) {
  sim::VehicleInstance& instance = instance_of(world, vehicle);
  sim::VehicleConfig changed = *instance.config;
  if (perturbation.friction) set_friction(world, changed, *perturbation.friction);
  for (sim::BodyConfig& body : changed.bodies)
    for (sim::PartConfig& part : body.parts) {
      if (part.mass_kg) *part.mass_kg *= perturbation.mass;
      if (part.density_kgpm3) *part.density_kgpm3 *= perturbation.mass;
    }
  for (sim::DeviceConfig& device : changed.devices)
    if (const auto* params = params_of<devices::JointServo::Params>(device)) {
      devices::JointServo::Params servo = *params;
      servo.max_effort *= perturbation.effort;
      if (servo.gear.line.stall_effort) *servo.gear.line.stall_effort *= perturbation.effort;
      if (servo.control == devices::JointServo::Control::velocity && servo.kp > 0)
        // The gain of a velocity servo is the inverse of its time constant, so a lag adds to 1 / kp.
        servo.kp = 1 / (1 / servo.kp + perturbation.lag_s);
      set_params(device, servo);
    }
  if (perturbation.ground_m > 0) {
    add_bumps(world, instance, perturbation);
    // Above the highest bump, or the vehicle would start inside the ground.
    instance.X_WV.translation().z() += perturbation.ground_m;
  }
  // Steps are whole microseconds.
  if (perturbation.half_step) world.physics.step_s = std::round(world.physics.step_s * 1e6 / 2) / 1e6;
  instance.config = std::make_shared<const sim::VehicleConfig>(std::move(changed));
  return world;
}

void set_played_motion(sim::WorldConfig& world, const std::string& vehicle, const sim::JointMotion& motion) {
  sim::VehicleInstance& instance = instance_of(world, vehicle);
  sim::VehicleConfig changed = *instance.config;
  for (sim::DeviceConfig& device : changed.devices)
    if (const auto* params = params_of<devices::MotionPlayer::Params>(device)) {
      devices::MotionPlayer::Params player = *params;
      player.motions = {{"", motion}};
      player.play = devices::FirstPlay{motion.name, {}, {}, {}, -1, false};
      set_params(device, player);
    }
  instance.config = std::make_shared<const sim::VehicleConfig>(std::move(changed));
}

}  // namespace motion
