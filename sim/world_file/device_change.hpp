// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "sim/world_file/world_config.hpp"

namespace sim {

/// The configuration of a device after some of its values have changed while it runs.  `values`: dotted key: value.
/// Values that cannot be read or changed are reported to `diagnostics`, and there is no result.
std::optional<DeviceConfig> changed_device(const DeviceConfig& device, const VehicleConfig& vehicle,
                                           const WorldConfig& world, const ConfigNode& values, const std::string& who,
                                           Diagnostics& diagnostics);

/// Null when there is none.
struct NamedDevice {
  const VehicleConfig* vehicle = nullptr;
  const DeviceConfig* device = nullptr;
};
/// The device `VEHICLE/DEVICE` of the world file.
NamedDevice device_of(const WorldConfig& world, const std::string& full_name);

}  // namespace sim
