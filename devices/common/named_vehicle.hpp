// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include "sim/world/world.hpp"

namespace devices {

/// Returns the configuration of a vehicle that a device names at construction, in the world or in the world file; null
/// when there is none of this name.
inline const sim::VehicleConfig* named_vehicle(const sim::World& world, const std::string& name) {
  if (const sim::Vehicle* vehicle = world.find_vehicle(name)) return &vehicle->config();
  const auto& all = world.config().vehicles;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
  return found == all.end() ? nullptr : found->config.get();
}

}  // namespace devices
