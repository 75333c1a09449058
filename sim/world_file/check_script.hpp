// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "sim/world_file/world_config.hpp"

namespace sim {

/// Returns the configuration of a device with some values changed at run time.  `values`: dotted key: value.  Values
/// that cannot be read or changed are reported to `diagnostics`; the result is then empty.
std::optional<DeviceConfig> changed_device(const DeviceConfig& device, const VehicleConfig& vehicle,
                                           const WorldConfig& world, const ConfigNode& values, const std::string& who,
                                           Diagnostics& diagnostics);

/// Device with its vehicle; null when there is none.
struct NamedDevice {
  const VehicleConfig* vehicle = nullptr;
  const DeviceConfig* device = nullptr;
};
/// Returns the device `VEHICLE/DEVICE` of the world file.
NamedDevice device_of(const WorldConfig& world, const std::string& full_name);

using FindDevice = std::function<NamedDevice(const std::string&)>;

/// Context of the check of an action.
class ActionCheck {
 public:
  /// `find_device`: finds a device VEHICLE/DEVICE.  All arguments must outlive this.
  ActionCheck(const WorldConfig& world, const FindDevice& find_device, Diagnostics& diagnostics,
              const ActionEntry& entry)
      : world_(world), find_device_(find_device), diagnostics_(diagnostics), entry_(entry) {}

  const WorldConfig& world() const { return world_; }
  const ActionEntry& entry() const { return entry_; }
  Diagnostics& diagnostics() const { return diagnostics_; }
  void error(const std::string& text) const;
  /// Returns the device VEHICLE/DEVICE.  Reports an error and returns an empty NamedDevice when there is none.
  NamedDevice device(const std::string& name) const;
  /// Checks the actions nested in an action.
  void check(const std::vector<ActionEntry>& actions) const;

 private:
  std::string devices_of(const std::string& vehicle) const;

  const WorldConfig& world_;
  const FindDevice& find_device_;
  Diagnostics& diagnostics_;
  const ActionEntry& entry_;
};

/// Checks a script after the vehicles of a world were loaded: objects of actors, and actions (devices, faults, changes
/// of parameters, messages, which are encoded here).
void check_script(WorldConfig& world, Diagnostics& diagnostics);

/// Checks a list of actions in the same way.
void check_actions(const std::vector<ActionEntry>& actions, const WorldConfig& world, const FindDevice& find_device,
                   Diagnostics& diagnostics);

}  // namespace sim
