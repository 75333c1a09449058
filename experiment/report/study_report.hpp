// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace experiment {

/// Returns the page of a study's folder, from its study.json.  Throws std::runtime_error with file and reason.
std::string study_report(const std::string& directory);

}  // namespace experiment
