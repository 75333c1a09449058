// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "experiment/files/json_reader.hpp"

namespace experiment {

/// Returns the page of a study's folder, from its study.json.  Throws std::runtime_error with file and reason.
std::string study_report(const std::string& directory);

/// Returns the part of a study's page about its algorithms of cooperative navigation: which one is best in each world,
/// a chart of the rms over the bound, a table of algorithms and worlds, and differences in pairs.  Empty for a study
/// without algorithms.  Throws std::runtime_error with the key and the rule.
std::string study_algorithms_html(const JsonReader& in);

/// Parts of the page of a study, from its study.json.  Each is empty when an older file lacks the data.  They throw
/// std::runtime_error with the key and the rule.

/// Returns curves of the figures over each factor, and of means over the number of seeds, as SVG.  `units`: of figures.
std::string study_charts_html(const JsonReader& in, const std::map<std::string, std::string>& units);
/// Returns the table of differences in pairs of equal seeds.
std::string study_comparisons_html(const JsonReader& in);
/// Returns the runs with the largest and smallest figures, with links to their pages and films in the folder of the
/// study.
std::string study_extremes_html(const JsonReader& in, const std::string& directory);

}  // namespace experiment
