// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_editor.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "sim/config/diagnostics.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_builder.hpp"
#include "sim/world/world_checks.hpp"
#include "sim/world/world_journal.hpp"
#include "sim/world/world_parts.hpp"

namespace sim {

WorldObserver* WorldEditor::observer() const {
  return parts_.observer;
}

void WorldEditor::report(Occurrence::Kind kind, const std::string& who, const std::string& text) const {
  if (parts_.observer != nullptr) parts_.observer->happened({kind, who, text});
}

void WorldEditor::check_new_vehicle(const VehicleInstance& instance) const {
  const std::string who = "vehicle " + shown_name(instance.name);
  parts_.entities.check_new_name(instance.name, instance.place, who);
  const VehicleConfig& config = *instance.config;
  const LimitsConfig& limits = parts_.config.limits;
  check_limit("vehicles", parts_.entities.vehicles().size() + 1, limits.vehicles, instance.place, who);
  check_limit("bodies in a vehicle", config.bodies.size(), limits.bodies_per_vehicle, instance.place, who);
  check_limit("devices in a vehicle", config.devices.size(), limits.devices_per_vehicle, instance.place, who);
  check_limit("joints in a vehicle", config.joints.size(), limits.parts, instance.place, who);
  check_limit("parts in a vehicle", config.part_count(), limits.parts, instance.place, who);
  std::set<std::string, std::less<>> own;
  for (const DeviceConfig& device : config.devices)
    for (const ChannelKind kind : all_channel_kinds) {
      const std::string channel = device_channel(parts_.config.channels, instance.name, device, kind);
      const std::string error = channel_error(channel, parts_.buses.taken(channel) || !own.insert(channel).second);
      if (!error.empty()) throw_config_error(device.place, who + ": device " + shown_name(device.name), error);
    }
}

void WorldEditor::check_place_is_free(Vehicle& vehicle, const VehicleInstance& instance) {
  constexpr double allowed_m = 0.05;
  const auto [other, depth_m] = parts_.physics.deepest_overlap(vehicle.group());
  if (depth_m <= allowed_m) return;
  builder_.dismantle(vehicle);
  throw_config_error(instance.place, "vehicle " + shown_name(instance.name),
                     "'position_m' is taken: it would stand " + number_text(std::round(depth_m * 1000) / 1000) +
                         " m deep in '" + other + "'");
}

const Vehicle& WorldEditor::add_vehicle(const VehicleInstance& instance) {
  // Check the vehicle before any change.
  check_new_vehicle(instance);
  parts_.surfaces.check_new(instance);
  const bool new_surfaces = parts_.surfaces.has_new(*instance.config);
  try {
    parts_.physics.add_categories(instance.config->categories);
  } catch (const std::length_error& error) {
    throw_config_error(instance.place, "vehicle " + shown_name(instance.name), error.what());
  }
  // Add its surfaces and the vehicle.
  parts_.surfaces.add(*instance.config);
  try {
    check_place_is_free(builder_.build_vehicle(instance), instance);
  } catch (...) {
    journal_.vehicle_failed(instance, new_surfaces);
    throw;
  }
  Vehicle& vehicle = *parts_.entities.vehicles().back();
  journal_.vehicle_added(instance, vehicle, new_surfaces);
  Warnings& warnings = parts_.warnings.building();
  for (const Warning& warning : parts_.hydrodynamics->take_warnings()) warnings.warn(warning);
  for (const std::string& warning : bottom_warnings(world_, vehicle)) warnings.warn({}, "", warning);
  warn_of_plans(world_, vehicle, warnings);
  builder_.schedule(vehicle);
  report(Occurrence::Kind::added, instance.name, "vehicle");
  return vehicle;
}

const WorldConfig& WorldEditor::config() const {
  return parts_.config;
}

const StepClock& WorldEditor::clock() const {
  return parts_.clock;
}

const Entities& WorldEditor::entities() const {
  return parts_.entities;
}

PhysicsWorld& WorldEditor::physics() {
  return parts_.physics;
}

Bus& WorldEditor::bus_of_channel(const std::string& channel) {
  return parts_.buses.of_channel(channel);
}

WorldWarnings& WorldEditor::warnings() {
  return parts_.warnings;
}

void WorldEditor::check_removable(const std::string& name) const {
  parts_.entities.vehicle_named(name);
  for (const MetricConfig& metric : parts_.config.metrics)
    if (metric.params && metric.params->vehicle == name)
      throw WorldError("vehicle " + shown_name(name) + " cannot be removed: metric '" + metric.name + "' scores it");
}

void WorldEditor::remove_vehicle(const std::string& name) {
  check_removable(name);
  Vehicle& vehicle = parts_.entities.vehicle_named(name);
  const std::string own_name = vehicle.name();  // the argument may refer to the name of the vehicle
  builder_.dismantle(vehicle);
  journal_.vehicle_removed(own_name);
  report(Occurrence::Kind::removed, own_name, "vehicle");
}

void WorldEditor::move_vehicle(const std::string& name, const Pose& X_WV) {
  const Vehicle& vehicle = parts_.entities.vehicle_named(name);
  parts_.physics.move_group(vehicle.group(), X_WV * vehicle.X_WV().inverse());
  if (parts_.physics.anchored(vehicle.group())) journal_.anchored_moved(vehicle.name(), vehicle.group());
  parts_.acoustics->discard_places();
  for (MountedDevice* const device : vehicle.devices()) device->displaced();
  report(Occurrence::Kind::moved, vehicle.name(), "vehicle");
}

const WorldObject& WorldEditor::add_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE) {
  const std::string who = "object " + shown_name(name);
  const LimitsConfig& limits = parts_.config.limits;
  parts_.entities.check_new_name(name, config.place, who);
  check_limit("objects", parts_.entities.objects().size() + 1, limits.objects, config.place, who);
  // One of the file of the world may be larger: it was there at the start.
  const auto& own = parts_.config.objects;
  if (!std::any_of(own.begin(), own.end(),
                   [&](const ObjectConfig& object) { return config.source && object.source == config.source; })) {
    check_limit("bodies in an object", config.bodies.size(), limits.bodies_per_vehicle, config.place, who);
    check_limit("joints in an object", config.joints.size(), limits.parts, config.place, who);
    check_limit("parts in an object", config.part_count(), limits.parts, config.place, who);
  }
  const WorldObject& object = builder_.place_object(config, name, X_WE);
  journal_.object_added(config, object, X_WE);
  report(Occurrence::Kind::added, name, "object");
  return object;
}

void WorldEditor::remove_object(const std::string& name) {
  const WorldObject& object = parts_.entities.object_named(name);
  const std::string own_name = object.name;  // the argument may refer to the name of the object
  builder_.dismantle(object);
  journal_.object_removed(own_name);
  report(Occurrence::Kind::removed, own_name, "object");
}

void WorldEditor::move_object(const std::string& name, const Pose& X_WE) {
  const WorldObject& object = parts_.entities.object_named(name);
  object.place(parts_.physics, X_WE);
  if (parts_.physics.anchored(object.group())) journal_.anchored_moved(object.name, object.group());
  report(Occurrence::Kind::moved, object.name, "object");
}

void WorldEditor::set_fault(const std::string& device, const FaultConfig& fault) {
  MountedDevice& mounted = parts_.entities.device_named(device);
  const std::string error = fault_misfit(*mounted.config().device_type, fault);
  if (!error.empty()) throw WorldError("device " + shown_name(device) + ": " + error);
  mounted.set_fault(fault);
  parts_.step_hash.forget_devices();
  report(Occurrence::Kind::fault, mounted.full_name(), std::string(word_of(fault_kind_words, fault.kind)));
}

void WorldEditor::clear_faults(const std::string& device) {
  parts_.entities.device_named(device).clear_faults();
  parts_.step_hash.forget_devices();
  report(Occurrence::Kind::fault, device, "cleared");
}

bool WorldEditor::change_device(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics) {
  const bool changed = builder_.change_device(full_name, values, diagnostics);
  if (changed) journal_.device_changed(full_name, values);
  if (changed) report(Occurrence::Kind::changed, full_name, "parameters");
  return changed;
}

void WorldEditor::set_gravity(double gravity_mps2) {
  parts_.physics.set_gravity(gravity_mps2);
  report(Occurrence::Kind::changed, "gravity", number_text(gravity_mps2) + " m/s2");
}

void WorldEditor::publish(const std::string& channel, std::span<const std::byte> payload) {
  parts_.buses.of_channel(channel).publish(channel, payload, parts_.clock.now());
}

void WorldEditor::end(const EndOfRun& end) {
  if (parts_.ended) return;
  parts_.ended = end;
  report(Occurrence::Kind::ended, "", end.text);
}

void WorldEditor::run_action(const ConfigNode& action) {
  Diagnostics diagnostics(parts_.config.files);
  parts_.script->run_now(action, diagnostics);
  diagnostics.throw_if_any();
}

}  // namespace sim
