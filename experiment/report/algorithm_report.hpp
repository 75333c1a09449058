// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/files/json_reader.hpp"

namespace experiment {

/// Returns the part of a study's page about its algorithms of cooperative navigation: which one is best in each world,
/// a chart of the rms over the bound, a table of algorithms and worlds, and differences in pairs.  Empty for a study
/// without algorithms.  Throws std::runtime_error with the key and the rule.
std::string study_algorithms_html(const JsonReader& in);

}  // namespace experiment
