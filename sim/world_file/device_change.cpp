// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/device_change.hpp"

#include <algorithm>
#include <set>

#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"

namespace sim {

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
