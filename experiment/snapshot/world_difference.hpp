// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/world_file/load_world.hpp"

namespace experiment {

/// Returns the entities that only the first world has, by name: `object 'box'`, `vehicle 'r1'`, `device 'r1/lidar'`,
/// `event 'storm'`.
std::vector<std::string> entities_only_in(const sim::WorldConfig& world, const sim::WorldConfig& other);

}  // namespace experiment
