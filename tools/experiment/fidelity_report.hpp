#pragma once

#include <string>
#include <vector>

#include "tools/experiment/fidelity.hpp"

namespace tools {

/// The table of differences, in columns for a terminal that are a table in Markdown too.
std::string fidelity_table(const std::vector<FidelityResult>& results);

/// Writes FOLDER/fidelity.md, and for each case FOLDER/fidelity/NAME.png (reference and ours over each other) and
/// NAME.csv (ours, in the columns of the reference).  Throws std::runtime_error.
void write_fidelity_report(const std::string& folder, const std::vector<FidelityResult>& results);

}  // namespace tools
