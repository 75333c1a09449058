// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/experiment/results/run_record.hpp"
#include "tools/experiment/study/study_config.hpp"

namespace tools {

struct StudyOptions {
  std::string output;  ///< folder of the study
  int jobs = 1;        ///< number of concurrent runs
  bool fresh = false;  ///< repeats finished runs
  bool quiet = false;
  std::vector<std::string> allow_paths = {};  ///< of the runs
};

/// Run of a study.
struct StudyRun {
  std::size_t in_case = 0;
  std::int64_t seed = 0;
  std::string directory;            ///< OUTPUT/runs/CASE/seed_N
  std::optional<RunRecord> record;  ///< unset: it failed, or was not started
  std::string failure;              ///< reason of the failure
};

/// Returns the runs of a study, in the order of cases and seeds; starts none.
std::vector<StudyRun> plan_study(const LoadedStudy& study, const std::string& output);

/// Executes the unfinished runs, each in its own `shoal run` and on its own LCM ports.  A finished run is kept when
/// world, settings, duration and version of shoal are unchanged.  A signal ends the children and returns; see
/// caught_signal().  Throws std::runtime_error when a folder cannot be created or a child cannot be started.
void run_study(const LoadedStudy& study, const StudyOptions& options, std::vector<StudyRun>& runs);

}  // namespace tools
