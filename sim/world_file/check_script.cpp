// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/check_script.hpp"

#include <algorithm>
#include <set>

#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"

namespace sim {
namespace {

void check_actor(const ActorConfig& actor, WorldConfig& world, Diagnostics& diagnostics) {
  const std::string who = "actor '" + actor.name + "'";
  for (ObjectConfig& object : world.objects) {
    if (object.name != actor.object) continue;
    if (object.count != 1) diagnostics.error(actor.place, who, "'object' must be one object, not a 'count' of them");
    if (const std::string error = object.error_of_leading(); !error.empty())
      diagnostics.error(actor.place, who, "object '" + object.name + "' " + error);
    if (object.led())
      diagnostics.error(actor.place, who, "object '" + object.name + "' is already moved by another actor");
    object.bodies.front().kinematic = true;
  }
}

}  // namespace

void ActionCheck::error(const std::string& text) const {
  diagnostics_.error(entry_.place, entry_.who, text);
}

NamedDevice ActionCheck::device(const std::string& name) const {
  const NamedDevice found = find_device_(name);
  if (found.device != nullptr && found.device->device_type != nullptr) return found;
  error("there is no device '" + shortened(printable(name)) + "'; devices are named VEHICLE/DEVICE" +
        devices_of(name.substr(0, name.find('/'))));
  return {};
}

/// Returns `; vehicle 'r1' has: gps, imu`; empty when there is no such vehicle.
std::string ActionCheck::devices_of(const std::string& vehicle) const {
  for (const VehicleInstance& instance : world_.vehicles) {
    if (instance.name != vehicle || !instance.config) continue;
    std::vector<std::string> names;
    for (const DeviceConfig& device : instance.config->devices) names.push_back(device.name);
    return "; vehicle '" + vehicle + "' has: " + list_text(names);
  }
  return {};
}

void ActionCheck::check(const std::vector<ActionEntry>& actions) const {
  check_actions(actions, world_, find_device_, diagnostics_);
}

void check_actions(const std::vector<ActionEntry>& actions, const WorldConfig& world, const FindDevice& find_device,
                   Diagnostics& diagnostics) {
  for (const ActionEntry& entry : actions)
    if (entry.action) entry.action->check({world, find_device, diagnostics, entry});
}

void check_script(WorldConfig& world, Diagnostics& diagnostics) {
  for (const ActorConfig& actor : world.actors) check_actor(actor, world, diagnostics);
  const FindDevice find = [&](const std::string& name) { return device_of(world, name); };
  for (const EventConfig& event : world.events) {
    if (event.every_s > 0 && event.every_s < world.physics.step_s)
      diagnostics.error(event.place, "event '" + event.name + "'",
                        "'every' must be at least a step of " + number_text(world.physics.step_s) + " s");
    check_actions(event.actions, world, find, diagnostics);
  }
}

namespace {

/// Returns the keys common to all devices (or actuators), without those of the type.
std::set<std::string> common_keys(const DeviceType& type) {
  std::vector<ParamInfo> table;
  ParamReader in(table);
  DeviceConfig config;
  config.read_common(in);
  if (type.is_actuator()) config.read_actuator(in, type);
  std::set<std::string> keys;
  for (const ParamInfo& info : table) keys.insert(info.key);
  return keys;
}

/// Returns why a key cannot change; empty when it can.
std::string why_not(const DeviceType& type, const std::string& key, const std::set<std::string>& common) {
  for (const char* fixed : {"name", "type", "body", "position_m", "rpy_deg", "channel"})
    if (key == fixed) return "'" + key + "' cannot change while the device runs";
  for (const std::string& fixed : type.fixed_keys)
    if (key == fixed) return "'" + key + "' cannot change while the device runs";
  if (type.changeable || common.contains(key)) return {};
  return "'" + shortened(printable(key)) + "' cannot change while a device of type " + type.name + " runs";
}

/// Declares the names that a device may refer to: see VehicleConfig::read.
void declare_names(ParamReader& in, const VehicleConfig& vehicle, const WorldConfig& world) {
  declare_surfaces(in, world, &vehicle);
  vehicle.declare_bodies(in);
  for (const JointConfig& joint : vehicle.joints) in.declare("joint", joint.name);
  for (const DeviceConfig& device : vehicle.devices) in.declare("device", device.name);
}

}  // namespace

std::optional<DeviceConfig> changed_device(const DeviceConfig& device, const VehicleConfig& vehicle,
                                           const WorldConfig& world, const ConfigNode& values, const std::string& who,
                                           Diagnostics& diagnostics) {
  const std::size_t errors_before = diagnostics.lines().size();
  // The whole device is read again from its YAML with the changed keys, so that every rule between keys is checked as
  // at the start.
  ConfigNode source = *device.source;
  const std::set<std::string> common = common_keys(*device.device_type);
  if (values.kind != ConfigNode::Kind::map)
    diagnostics.error(values.place, who, "'values' must be a map of keys and values, got " + shown(values));
  for (const ConfigNode::Entry& entry : values.entries) {
    const std::string key = entry.key.substr(0, entry.key.find('.'));
    if (const std::string reason = why_not(*device.device_type, key, common); !reason.empty())
      diagnostics.error(entry.place, who, reason);
    else
      set_config_path(source, entry.key, entry.value, entry.place, diagnostics);
  }
  ParamReader in(source, who, diagnostics);
  declare_names(in, vehicle, world);
  DeviceConfig changed;
  changed.read(in);
  in.finish();
  if (diagnostics.lines().size() != errors_before) return std::nullopt;
  return changed;
}

NamedDevice device_of(const WorldConfig& world, const std::string& full_name) {
  const std::size_t slash = full_name.find('/');
  if (slash == std::string::npos) return {};
  const std::string vehicle = full_name.substr(0, slash);
  for (const VehicleInstance& instance : world.vehicles) {
    if (instance.name != vehicle || !instance.config) continue;
    for (const DeviceConfig& device : instance.config->devices)
      if (device.name == full_name.substr(slash + 1)) return {instance.config.get(), &device};
  }
  return {};
}

}  // namespace sim
