// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/config/param_info.hpp"

namespace tools {

/// Returns the JSON Schema (draft 7) of a file, for editors and validators, generated from the tables of the loader.
/// The loader may still reject what the schema accepts: names that must exist, sums, limits that depend on other keys.
/// `file`: world or vehicle.  Throws std::out_of_range for any other.
std::string json_schema(const std::string& file);

/// Returns the schema of a study, whose keys are `table`.
std::string study_schema(const std::vector<sim::ParamInfo>& table);

/// Returns the schema of a motion file, whose keys are `table`.
std::string motion_schema(const std::vector<sim::ParamInfo>& table);

/// Returns the schema of a drive profile, whose keys are `table`.
std::string drive_schema(const std::vector<sim::ParamInfo>& table);

}  // namespace tools
