// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace sim {

class Vehicle;
class World;

/// A line when vehicles that are in water, or float on it, have no ground below them and a device that needs it,
/// because it casts rays or declares it (Sensor::needs_bottom).
std::vector<std::string> bottom_warnings(const World& world);
/// The same for one of them.
std::vector<std::string> bottom_warnings(const World& world, const Vehicle& vehicle);

}  // namespace sim
