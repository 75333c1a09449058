// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "sim/world_file/device_change.hpp"

namespace sim {

/// What is checked once the vehicles of a world are known: objects of actors, devices, faults, changes of values,
/// messages (which are encoded now).
void check_script(WorldConfig& world, Diagnostics& diagnostics);

/// The same for actions.  `find_device`: by VEHICLE/DEVICE.
void check_actions(std::vector<Action>& actions, const WorldConfig& world,
                   const std::function<NamedDevice(const std::string&)>& find_device, Diagnostics& diagnostics);

}  // namespace sim
