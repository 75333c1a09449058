// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiment/results/run_record.hpp"
#include "experiment/study/load_study.hpp"

namespace experiment {

struct StudyOptions {
  std::string output;  ///< folder of the study
  int jobs = 1;        ///< number of concurrent runs
  int threads = 1;     ///< that share the work of a step, in each run
  bool fresh = false;  ///< repeats finished runs
  bool quiet = false;
  std::vector<std::string> allow_paths = {};  ///< of the runs
  double run_timeout_s = 0;                   ///< wall time after which a run is ended and has failed; 0: none
  bool any_version = false;                   ///< keeps runs that another version of shoal has finished
};

/// Run of a study.
struct StudyRun {
  std::size_t index = 0;  ///< number in the plan, from 1
  std::size_t in_case = 0;
  std::size_t point = 0;  ///< of the design
  std::int64_t seed = 0;
  std::string directory;                 ///< OUTPUT/runs/CASE/seed_N, with a design OUTPUT/runs/CASE/point_P/seed_N
  std::optional<RunRecord> record = {};  ///< unset: it failed, or has not been run
  std::string failure = {};              ///< why there is no record
  bool tried = false;                    ///< it has been run, and failed
};

/// Returns the runs of a study, in the order of cases, points and seeds; starts none.
std::vector<StudyRun> plan_study(const LoadedStudy& study, const std::string& output);

/// Returns the settings `path=value` of a run: those of its case, then those of its point.
std::vector<std::string> sets_of(const LoadedStudy& study, const StudyRun& run);

/// Returns the hash of all that a run depends on except the program: world, settings, seed, duration, launch; 16
/// hexadecimal digits.
std::string inputs_of(const LoadedStudy& study, const StudyRun& run);

/// Returns the command that repeats a run alone, with the results in the present folder.
std::string command_of(const LoadedStudy& study, const StudyRun& run);

/// Returns the arguments of `shoal run` that executes a run with its results in a folder, on LCM ports that depend on
/// this process, on `slot` and on `attempt`.  `threads`: 0: one for each processor.
std::vector<std::string> arguments_of(const LoadedStudy& study, const StudyRun& run, const std::string& results,
                                      const std::vector<std::string>& allow_paths, int threads, int slot, int attempt);

/// Reads the result of a run that was finished with these inputs.  `any_version`: by any version of shoal.  Otherwise
/// `failure` is set.
void read_result(const LoadedStudy& study, bool any_version, StudyRun& run);

/// Count of the runs of a command, which may execute them in several parts.
struct StudyProgress {
  std::size_t total = 0;
  std::size_t done = 0;  ///< with or without a result
  std::size_t kept = 0;  ///< of these, finished before
};

/// Executes the unfinished runs among `which` (indices into `runs`), each in its own `shoal run` and on its own LCM
/// ports.  A finished run is kept when world, settings, duration and (without `any_version`) version of shoal are
/// unchanged.  A run that another process executes is awaited.  A signal ends the children and returns; see
/// caught_signal().  Throws std::runtime_error when a folder cannot be created or a child cannot be started.
void run_study(const LoadedStudy& study, const StudyOptions& options, std::vector<StudyRun>& runs,
               const std::vector<std::size_t>& which, StudyProgress& progress);

/// Executes runs by an engine, batch after batch of seeds while the study has an `until` that does not hold.
/// `execute` gets indices into `runs` and leaves their results in them.
void run_in_batches(const LoadedStudy& study, std::vector<StudyRun>& runs,
                    const std::function<void(const std::vector<std::size_t>&)>& execute);

/// Number of seeds, from the first one, whose runs are the result of a study: all, or those up to the batch after which
/// `until` holds.  Depends only on the results, not on the order in which the runs ended.
std::size_t seeds_needed(const LoadedStudy& study, const std::vector<StudyRun>& runs);

/// Returns whether `until` holds for all seeds of the study and its runs; false without `until`.
bool until_holds(const LoadedStudy& study, const std::vector<StudyRun>& runs);

/// Returns the outcome of `until` in one line: `until: ci(e.rms_m) < 5 % holds after 10 of 40 seeds; ...`; empty: the
/// study has none.  The seeds that are not needed have been removed.
std::string until_text(const LoadedStudy& study, const std::vector<StudyRun>& runs);

/// Removes the seeds that are not needed from a study and its runs.
void drop_needless_seeds(LoadedStudy& study, std::vector<StudyRun>& runs);

}  // namespace experiment
