// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiment/results/run_record.hpp"

namespace experiment {

/// Returns the plots of a directory as HTML, each with its caption (by file name; default: the name); lists the plots
/// that are missing or not a complete PNG file.
std::string plots_html(const std::string& directory, const std::vector<std::string>& files,
                       const std::map<std::string, std::string>& captions);

/// Returns the plots of a run.
std::string run_plots_html(const RunRecord& run);

}  // namespace experiment
