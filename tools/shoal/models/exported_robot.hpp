// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/world_file/vehicle_config.hpp"
#include "tools/shoal/urdf/robot_description.hpp"

namespace tools {

/// Returns a vehicle as a robot of URDF: bodies are links, and the root link has the frame of the vehicle.  Its notes
/// say what URDF does not hold.  `masses`: those of the bodies in their frames.  `folder`: that of the file to write,
/// from which paths of meshes start.
RobotDescription exported_robot(const sim::VehicleConfig& vehicle, const std::vector<RobotInertial>& masses,
                                const std::string& folder);

/// Masses of the bodies of a vehicle, as a world has them; 0 of a body that is not free.
std::vector<RobotInertial> masses_of(const sim::VehicleConfig& vehicle);

}  // namespace tools
