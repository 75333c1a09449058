// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "experiment/study/study_results.hpp"

namespace experiment {

/// Parts of the tables of a study, for StudyResults.

/// Program and machine of a run, on which its last bits depend.
struct RunKind {
  std::string version, processor, c_library;  ///< empty: not recorded
  bool operator<(const RunKind& other) const {
    return std::tie(version, processor, c_library) < std::tie(other.version, other.processor, other.c_library);
  }
};
RunKind kind_of(const RunRecord& record);

/// Returns the values of a point: `loss = 0.5, g = 1.62`.
std::string values_text(const StudyConfig& config, const StudyPoint& point);

nlohmann::ordered_json statistics_json(const Statistics& statistics);
nlohmann::ordered_json comparison_json(const StudyComparison& comparison);
/// Adds `factors`, `design` and `points` with their statistics, of at most 2000 points.
void add_points(nlohmann::ordered_json& json, const StudyResults& results);

/// Adds `convergence`: mean and interval of the first figures over the number of seeds, by case.
void add_convergence(nlohmann::ordered_json& json, const StudyResults& results);
/// Run with the largest or smallest value of a figure.
struct ExtremeRun {
  std::string figure;
  bool max = false;
  const StudyRun* run = nullptr;
};
/// Returns those of each figure of the table, if they differ.
std::vector<ExtremeRun> extreme_runs(const StudyResults& results);
/// Returns the folder, in that of the study, of a run that is shown: executed again with a record and its page.
std::string shown_folder(const StudyRun& run);

/// Adds `extremes`: of each figure of the table the runs with the largest and the smallest value, and how to view them.
void add_extremes(nlohmann::ordered_json& json, const StudyResults& results);

std::string comparisons_text(const std::vector<StudyComparison>& comparisons);
/// Returns a line for each of the first failed runs, with the command that repeats it in its folder.
std::string failed_text(const StudyResults& results, const std::string& directory);

}  // namespace experiment
