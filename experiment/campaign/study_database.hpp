// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/study/study_results.hpp"

namespace experiment {

/// Writes the results of a study into an SQLite database: tables `study`, `runs`, `figures` (a row for each figure of
/// each run), `factors` (a row for each factor of each point; numbers as numbers), `statistics` and `comparisons`.  A
/// figure or statistic without a value is NULL.  The file is complete under its name, or as it was before.  Throws
/// std::runtime_error.
void write_database(const std::string& path, const StudyResults& results);

}  // namespace experiment
