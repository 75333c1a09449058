// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/config/param_info.hpp"

namespace tools {

/// JSON Schema (draft 7) of a file, for editors and validators, made from the tables that the loader reads by.  What
/// it accepts may still be refused by the loader: names that must exist, sums, limits that depend on other keys.
/// `file`: world or vehicle.  Throws std::out_of_range on any other.
std::string json_schema(const std::string& file);

/// The same of a study, whose keys are `table`.
std::string study_schema(const std::vector<sim::ParamInfo>& table);

}  // namespace tools
