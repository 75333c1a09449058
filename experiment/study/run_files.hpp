// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "bridges/base/file_descriptor.hpp"
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

/// Claim on the folder of a run against other processes that execute the same study.  It ends with the process, however
/// that ends, and on network file systems that have locks.
class RunClaim {
 public:
  /// Creates the folder, below `root`: that of the study.  Throws std::runtime_error when that is not possible, or a
  /// part of it is a symbolic link.
  RunClaim(const std::string& root, const std::string& directory);
  /// Returns the process that has the folder; none when it is claimed by this object now.
  const std::optional<std::string>& owner() const { return owner_; }

 private:
  bridges::FileDescriptor file_;
  std::optional<std::string> owner_;
};

}  // namespace experiment
