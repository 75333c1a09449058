// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tools {

/// Returns a commented world of one vehicle.  `vehicle_file`: as in `file:`; `schema`: path of world.schema.json,
/// empty: none.
std::string start_world(const std::string& name, const std::string& vehicle_file, const std::string& schema);
/// Returns the same under water: an AUV with an autopilot.
std::string start_sea(const std::string& name, const std::string& vehicle_file, const std::string& schema);
/// Returns a commented rover with two driven wheels, or an AUV.  `schema`: path of vehicle.schema.json, empty: none.
std::string start_vehicle(const std::string& name, bool under_water, const std::string& schema);

}  // namespace tools
