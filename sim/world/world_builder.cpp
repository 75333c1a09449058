// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_builder.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sim/config/diagnostics.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/world/memory_forecast.hpp"
#include "sim/world/world_parts.hpp"
#include "sim/world_file/check_script.hpp"

namespace sim {

WorldBuilder::WorldBuilder(WorldParts& parts) : parts_(parts) {
  StateArchive start = StateArchive::saver();
  start(parts_.medium);
  medium_at_start_ = start.take_bytes();
}

void WorldBuilder::build() {
  const WorldConfig& config = parts_.config;
  parts_.hydrodynamics.emplace(
      parts_.medium, config.physics.gravity_mps2, config.physics.step_s,
      [&parts = parts_](const std::string& who, const std::string& text) { parts.warnings.warn(who, text); });
  parts_.acoustics = std::make_unique<AcousticChannel>(
      config.acoustics, AcousticSurroundings{parts_.medium, parts_.physics, parts_.events, parts_.seed()});
  parts_.acoustics->set_observer(parts_.observer);
  // Materials come first, since parts name them.
  parts_.surfaces.start(config);
  add_objects();
  add_vehicles();
  sort_devices();
}

void WorldBuilder::add_objects() {
  for (const ObjectConfig& object : parts_.config.objects) {
    if (!object.present) continue;
    const Pose X_WE = make_pose(object.position_m, object.rpy_rad);
    const std::vector<Pose> poses =
        object.count == 1 ? std::vector<Pose>{X_WE}
                          : place_instances(object.placement, object.count, X_WE, parts_.seed(), object.name);
    const auto config = std::make_shared<const ObjectConfig>(object);
    for (int i = 0; i < object.count; ++i)
      build_object(config, object.count == 1 ? object.name : object.name + std::to_string(i + 1),
                   poses[static_cast<std::size_t>(i)]);
  }
}

void WorldBuilder::add_vehicles() {
  std::vector<std::string> errors;  // of all vehicles, not only the first; equal errors of vehicles of one model once
  std::set<std::string> known;
  // A file of `count`s of a few lines may describe more vehicles than the memory holds.
  MemoryForecast forecast(parts_.config.vehicles.size(), allocated_bytes(), available_bytes());
  std::size_t built = 0;
  for (const VehicleInstance& instance : parts_.config.vehicles) {
    if (!parts_.config.bodies_only_of_many && forecast.is_due(built))
      if (const std::string problem = forecast.problem(built, allocated_bytes().value_or(0)); !problem.empty())
        throw_config_error(instance.place, "vehicle '" + instance.name + "'", problem);
    ++built;
    try {
      build_vehicle(instance);
    } catch (const ConfigError& error) {
      for (const std::string& line : error.lines()) {
        std::string without_name = line;
        if (const auto name = without_name.find("'" + instance.name + "'"); name != std::string::npos)
          without_name.erase(name, instance.name.size() + 2);
        if (known.insert(without_name).second) errors.push_back(line);
      }
    }
  }
  if (!errors.empty()) throw ConfigError(errors);
}

const WorldObject& WorldBuilder::build_object(std::shared_ptr<const ObjectConfig> config, const std::string& name,
                                              const Pose& X_WE) {
  WorldObject object(parts_.entities.take_object_number(), name, parts_.physics.add_group(name, config->self_collision),
                     config);
  try {
    build_bodies_of(object, *config, X_WE, config->fixed);
    build_joints_of(object, *config, X_WE);
  } catch (...) {
    // What was added must go again, or a half-built group would stay in the world.
    parts_.hydrodynamics->remove_group(object.group());
    parts_.physics.remove_group(object.group());
    throw;
  }
  parts_.physics.close_group(object.group());
  parts_.entities.mark_changed();
  return parts_.entities.add(std::move(object));
}

const WorldObject& WorldBuilder::place_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE) {
  // An object moved by an actor must be kinematic, even when another object of its name is added.
  const bool led = std::any_of(parts_.config.actors.begin(), parts_.config.actors.end(),
                               [&](const ActorConfig& actor) { return actor.object == name; });
  const auto own = std::make_shared<ObjectConfig>(config);
  if (led && !config.led()) {
    if (const std::string error = config.error_of_leading(); !error.empty())
      throw_config_error(config.place, "object " + shown_name(name),
                         "an actor leads an object of this name; it " + error);
    own->bodies.front().kinematic = true;
  }
  return build_object(own, name, X_WE);
}

Vehicle& WorldBuilder::build_vehicle(const VehicleInstance& instance) {
  const int group = parts_.physics.add_group(instance.name, instance.config->self_collision);
  Vehicle& vehicle = parts_.entities.add(std::make_unique<Vehicle>(
      instance.name, parts_.entities.take_vehicle_number(), group, instance.config, parts_.buses.named(instance.bus),
      VehicleClock(instance.config->clock, parts_.seed(), instance.name, parts_.clock.now())));
  try {
    build_parts_of(vehicle, instance);
  } catch (...) {  // a mesh that is not a solid, a port in use: remove everything that was built
    dismantle(vehicle);
    throw;
  }
  parts_.entities.mark_changed();
  return vehicle;
}

void WorldBuilder::build_parts_of(Vehicle& vehicle, const VehicleInstance& instance) {
  const VehicleConfig& config = *instance.config;
  build_bodies_of(vehicle, config, instance.X_WV, false);
  // Errors in joints and devices of a model were found in its first vehicles.
  constexpr int max_of_kind_as_a_whole = 100;
  if (parts_.config.bodies_only_of_many && parts_.config.events.empty() &&
      ++built_of_kind_[&config] > max_of_kind_as_a_whole)
    return parts_.physics.close_group(vehicle.group());
  // Add joints and devices.
  build_joints_of(vehicle, config, instance.X_WV);
  parts_.physics.close_group(vehicle.group());
  std::vector<std::string> errors;
  for (const DeviceConfig& device : config.devices) {
    try {
      add_device(vehicle, device);
    } catch (const ConfigError& error) {
      errors.insert(errors.end(), error.lines().begin(), error.lines().end());
    }
  }
  if (!errors.empty()) throw ConfigError(errors);
}

void WorldBuilder::build_bodies_of(Mechanism& owner, const MechanismConfig& config, const Pose& X_WV, bool fixed) {
  for (const BodyConfig& body : config.bodies) {
    const Motion motion = body.kinematic ? Motion::kinematic : fixed ? Motion::fixed : Motion::free;
    Body& built = parts_.physics.add_body(owner.group(), body, X_WV, motion);
    owner.add_body(body.name, built);
    if (motion == Motion::free) parts_.hydrodynamics->add_body(built, body);
  }
}

void WorldBuilder::build_joints_of(Mechanism& owner, const MechanismConfig& config, const Pose& X_WV) {
  for (const JointConfig& joint : config.joints) {
    Body* second = joint.bodies[1] == "world" ? nullptr : &owner.body(joint.bodies[1]);
    owner.add_joint(joint.name,
                    parts_.physics.add_joint(owner.group(), joint, owner.body(joint.bodies[0]), second, X_WV));
  }
}

void WorldBuilder::add_device(Vehicle& vehicle, const DeviceConfig& config) {
  auto device = std::make_unique<MountedDevice>(vehicle, config, parts_.host, parts_.devices.next_number());
  vehicle.add_device(*device);
  for (const ChannelKind kind : all_channel_kinds)
    parts_.buses.take(device_channel(parts_.config.channels, vehicle.name(), config, kind), vehicle.bus());
  parts_.devices.add(std::move(device));
}

void WorldBuilder::schedule(Vehicle& vehicle) {
  parts_.schedule.add(vehicle, parts_.devices);
}

void WorldBuilder::sort_devices() {
  parts_.schedule.sort(parts_.entities, parts_.devices, parts_.clock);
  parts_.step_hash.forget_devices();
}

void WorldBuilder::dismantle(Vehicle& vehicle) {
  parts_.schedule.remove(vehicle);
  for (const MountedDevice* device : vehicle.devices()) remove_device(*device);
  parts_.hydrodynamics->remove_group(vehicle.group());
  parts_.physics.remove_group(vehicle.group());
  parts_.entities.mark_changed();
  parts_.entities.remove(vehicle);
}

void WorldBuilder::remove_device(const MountedDevice& device) {
  parts_.events.drop_device(device.number());
  for (const ChannelKind kind : all_channel_kinds)
    parts_.buses.release(device_channel(parts_.config.channels, device.vehicle().name(), device.config(), kind));
  parts_.step_hash.drop_device(device.number());
  parts_.devices.remove(device.number());
}

void WorldBuilder::dismantle(const WorldObject& object) {
  parts_.hydrodynamics->remove_group(object.group());
  parts_.physics.remove_group(object.group());
  parts_.entities.mark_changed();
  parts_.entities.remove(object);
}

bool WorldBuilder::change_device(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics) {
  MountedDevice* device = parts_.entities.find_device(full_name);
  const std::string who = "device " + shown_name(full_name);
  if (device == nullptr) {
    diagnostics.error(values.place, who, "there is no such device; devices are named VEHICLE/DEVICE");
    return false;
  }
  const auto changed =
      changed_device(device->config(), device->vehicle().config(), parts_.config, values, who, diagnostics);
  if (!changed) return false;
  try {
    device->change(*changed, parts_.clock.now());
  } catch (const std::runtime_error& error) {
    diagnostics.error(values.place, who, error.what());
    return false;
  }
  // The new keys may change the rate, and so the next sample, and what the device contributes to the step hash.
  parts_.schedule.plan_again(*device);
  parts_.step_hash.forget_devices();
  return true;
}

/// Dismantles devices before the objects to which they refer, as in the destructor of the world.
void WorldBuilder::dismantle_all() {
  parts_.script.reset();
  parts_.schedule.clear();
  parts_.devices.clear();
  parts_.entities.clear();
  parts_.buses.release_all();
  parts_.acoustics.reset();
  parts_.hydrodynamics.reset();
  parts_.shared = {};
  parts_.events = {};
  parts_.ended.reset();
  parts_.clock.step_number = 0;
}

void WorldBuilder::rebuild() {
  dismantle_all();
  const WorldConfig& config = parts_.config;
  parts_.physics.start_again(config.physics, config.materials, config.contacts, config.categories, parts_.seed());
  StateArchive start = StateArchive::restorer(medium_at_start_);
  start(parts_.medium);
  build();
  parts_.entities.mark_changed();
}

}  // namespace sim
