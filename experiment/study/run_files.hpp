// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "experiment/study/study_runs.hpp"

namespace experiment {

/// Files by which a study finds the state of a run, in the folder of the run.  Each is written as a whole: after a
/// kill or a loss of power it is complete or absent.  Writing and removing throw std::runtime_error for a symbolic
/// link.

/// Mark of a finished run.
struct RunStamp {
  std::string inputs;   ///< see inputs_of()
  std::string version;  ///< of shoal
};
/// Returns std::nullopt if there is no valid stamp.
std::optional<RunStamp> read_stamp(const std::string& directory);
void write_stamp(const std::string& directory, const RunStamp& stamp);

/// Mark of a run that failed.
struct RunFailure {
  std::string inputs;
  std::string reason;
};
std::optional<RunFailure> read_failure(const std::string& directory);
void write_failure(const std::string& directory, const RunFailure& failure);

/// Removes both marks, the summary and the files of the algorithms, before a run starts.
void remove_marks(const StudyRun& run);

/// Reads the summary of a run into its record, or its failure.
void read_summary(StudyRun& run);
/// Reads the summary of a run that has just ended, and the figures of its algorithms.
void read_ended_run(const LoadedStudy& study, StudyRun& run);

/// Returns the folder of a run.
std::string directory_of(const LoadedStudy& study, const std::string& output, std::size_t in_case, std::size_t point,
                         std::int64_t seed);

}  // namespace experiment
