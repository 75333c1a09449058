// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "experiment/study/study_runs.hpp"

namespace experiment {

/// Executes the runs with the largest and smallest figures of a study again, with a record, and writes the page of
/// each in DIRECTORY/shown/run_N: run.html, which the page of the study links to.  Pages of equal runs are kept.  A run
/// that differs from that of the study (its run hash) is reported, and has no page.  A signal ends it early.
void show_extreme_runs(const LoadedStudy& study, const std::vector<StudyRun>& runs, const std::string& directory,
                       const std::vector<std::string>& allow_paths);

}  // namespace experiment
