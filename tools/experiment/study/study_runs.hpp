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
  int jobs = 1;        ///< runs at the same time
  bool fresh = false;  ///< runs that are done are done again
  bool quiet = false;
  std::vector<std::string> allow_paths = {};  ///< of the runs
};

/// One run of a study.
struct StudyRun {
  std::size_t in_case = 0;
  std::int64_t seed = 0;
  std::string directory;            ///< OUTPUT/runs/CASE/seed_N
  std::optional<RunRecord> record;  ///< unset: it failed, or was not begun
  std::string failure;              ///< why
};

/// The runs of a study, in the order of cases and seeds; nothing has run.
std::vector<StudyRun> plan_study(const LoadedStudy& study, const std::string& output);

/// Runs what is not done yet, each in a `shoal run` of its own, on LCM ports of its own.  A run that is done is kept
/// when world, settings, duration and version of shoal were the same.  A signal ends the children and returns; see
/// caught_signal().  Throws std::runtime_error when a folder cannot be made or a child cannot be started.
void run_study(const LoadedStudy& study, const StudyOptions& options, std::vector<StudyRun>& runs);

}  // namespace tools
