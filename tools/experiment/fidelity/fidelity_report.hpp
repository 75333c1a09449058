// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/fidelity/fidelity.hpp"

namespace tools {

/// The table of differences, in columns for a terminal that are a table in Markdown too.
std::string fidelity_table(const std::vector<FidelityResult>& results);

/// How a case went, on one line: `2 of 24: otter_turn: position rms 0.0312 m`, and how many bars it missed.
std::string fidelity_line(const FidelityResult& result, std::size_t number, std::size_t count);

/// Writes FOLDER/fidelity.md, and for each case FOLDER/fidelity/NAME.png (reference and ours over each other) and
/// with `csv` NAME.csv (our states).  `text`: Markdown for the top.  Throws std::runtime_error.
void write_fidelity_report(const std::string& folder, const std::string& text,
                           const std::vector<FidelityResult>& results, bool csv);

}  // namespace tools
