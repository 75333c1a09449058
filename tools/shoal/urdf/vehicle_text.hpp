// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/shoal/urdf/imported_vehicle.hpp"

namespace tools {

/// Returns the vehicle file of an imported robot.  `schema`: path of vehicle.schema.json for editors; empty: none.
/// Computed numbers have 10 digits.
std::string vehicle_text(const ImportedVehicle& vehicle, const std::string& schema);

}  // namespace tools
