// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/config/param_info.hpp"
#include "sim/program/program_declaration.hpp"

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

/// Returns the declarations of the programs that come with Shoal, from the folder of the running one.
std::vector<sim::ProgramDeclaration> shipped_declarations();

/// Returns the JSON Schema of the `args:` of a program.
nlohmann::ordered_json args_schema(const sim::ProgramDeclaration& declaration);

/// Completes the schema of an item of `processes:`, in which `args:` depends on `program:`.  Adds the schemas of the
/// programs that come with Shoal to `definitions`.
void add_program_schemas(nlohmann::ordered_json& process, nlohmann::ordered_json& definitions);

}  // namespace tools
