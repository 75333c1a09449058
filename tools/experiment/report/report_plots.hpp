// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/experiment/results/run_record.hpp"

namespace tools {

/// Plots of a directory as HTML, with what each shows (by file name; none: the name); those that are missing or no
/// whole PNG are named.
std::string plots_html(const std::string& directory, const std::vector<std::string>& files,
                       const std::map<std::string, std::string>& captions);

/// The plots of a run.
std::string run_plots_html(const RunRecord& run);

}  // namespace tools
