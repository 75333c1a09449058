// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

}  // namespace sim
