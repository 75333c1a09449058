// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "sim/program/program_declaration.hpp"

namespace tools {

/// Returns the declarations of the programs that come with Shoal, from the folder of the running one.
std::vector<sim::ProgramDeclaration> shipped_declarations();

/// Returns the JSON Schema of the `args:` of a program.
nlohmann::ordered_json args_schema(const sim::ProgramDeclaration& declaration);

/// Completes the schema of an item of `processes:`, in which `args:` depends on `program:`.  Adds the schemas of the
/// programs that come with Shoal to `definitions`.
void add_program_schemas(nlohmann::ordered_json& process, nlohmann::ordered_json& definitions);

}  // namespace tools
