// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "verification/fidelity/fidelity.hpp"

namespace verification {

/// Returns the table of differences, aligned for a terminal and valid as Markdown.
std::string fidelity_table(const std::vector<FidelityResult>& results);

/// Returns the result of a case on one line: `2 of 24: otter_turn: position rms 0.0312 m`, and the number of exceeded
/// limits.
std::string fidelity_line(const FidelityResult& result, std::size_t number, std::size_t count);

/// Writes FOLDER/fidelity.md, FOLDER/fidelity/end_states.csv, and for each case FOLDER/fidelity/NAME.png (reference and
/// simulation overlaid) and, with `csv`, NAME.csv (our states).  `text`: Markdown for the top.  Throws
/// std::runtime_error.
void write_fidelity_report(const std::string& folder, const std::string& text,
                           const std::vector<FidelityResult>& results, bool csv);

/// Writes FOLDER/fidelity_coefficients.md and FOLDER/fidelity/coefficients.csv.  Throws std::runtime_error.
void write_fidelity_mutations(const std::string& folder, const std::string& page, const std::string& table);

}  // namespace verification
