// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace sim {

class Vehicle;
class World;

/// Returns a warning when vehicles in or on water have no bottom below them and a device that needs one, because it
/// casts rays or declares it (Sensor::needs_bottom).
std::vector<std::string> bottom_warnings(const World& world);
/// Returns the same for one vehicle.
std::vector<std::string> bottom_warnings(const World& world, const Vehicle& vehicle);

}  // namespace sim
