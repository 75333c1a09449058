// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "sim/program/program_declaration.hpp"

namespace tools {

/// The declarations of the programs that come with Shoal, beside the running one.
std::vector<sim::ProgramDeclaration> shipped_declarations();

/// JSON Schema of the `args:` of a program.
nlohmann::ordered_json args_schema(const sim::ProgramDeclaration& declaration);

/// Completes the schema of an item of `processes:`: what `args:` are depends on `program:`.  The schemas of the
/// programs that come with Shoal go to `definitions`.
void add_program_schemas(nlohmann::ordered_json& process, nlohmann::ordered_json& definitions);

}  // namespace tools
