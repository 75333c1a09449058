// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "experiment/study/study_runs.hpp"

namespace experiment {

/// Options of the engines that execute runs by `shoal study run DIR --index ...` in other processes.
struct EngineOptions {
  StudyOptions study;                   ///< `output`: the folder with the manifest
  std::size_t chunk = 0;                ///< runs of one command; 0: chosen by their number
  std::string ssh_login_file;           ///< of GNU parallel; empty: this machine
  std::string partition;                ///< of Slurm; empty: the default one
  std::string time_limit;               ///< of Slurm, for a chunk; empty: that of the partition
  std::vector<std::string> algorithms;  ///< in addition to those of the study
  std::vector<std::string> sbatch;      ///< further options of sbatch
  bool wait = true;                     ///< for the jobs of Slurm; otherwise they are only submitted
};

/// Result of a program that was run to its end.
struct ProgramOutput {
  int exit_code = 0;  ///< 128 plus the number of the signal that killed it
  std::string text;   ///< its stdout and stderr
};

/// Throws std::runtime_error when PATH has no such program: `sbatch is not installed: ...`.  `package`: that of Debian.
void require_program(const std::string& name, const std::string& package);

/// Runs a program, `arguments[0]` from PATH, with its output kept.  Throws std::runtime_error when it cannot start.
ProgramOutput output_of(const std::vector<std::string>& arguments);

/// Runs a program with our output, and ends it after a signal, by two of SIGTERM.  Returns its exit code.
int run_outside_program(const std::vector<std::string>& arguments);

/// Absolute path of this program.
std::string own_program();

/// Returns the runs among `which` that have no result.
std::vector<std::size_t> missing_runs(const LoadedStudy& study, const EngineOptions& options,
                                      std::vector<StudyRun>& runs, const std::vector<std::size_t>& which);

/// Divides runs into chunks of at most `size`.
std::vector<std::vector<std::size_t>> chunks_of(const std::vector<std::size_t>& which, std::size_t size);

/// Returns `shoal study run DIR ...` with all options but `--index`.
std::vector<std::string> chunk_command(const EngineOptions& options);

/// Executes the missing runs among `which` by GNU parallel, on this machine or those of a login file.  A signal ends
/// them.  Throws std::runtime_error when GNU parallel is not installed.
void run_by_parallel(const LoadedStudy& study, const EngineOptions& options, std::vector<StudyRun>& runs,
                     const std::vector<std::size_t>& which, StudyProgress& progress);

/// Executes the missing runs among `which` as job arrays of Slurm: at most MaxArraySize - 1 chunks each.  Jobs of an
/// earlier call that are still queued or running are awaited, not submitted again.  Runs that Slurm has lost (a node
/// failed, a time limit) are submitted again as long as that brings results.  A signal leaves the jobs in the queue.
/// Throws std::runtime_error when Slurm is not installed or refuses a job.
void run_by_slurm(const LoadedStudy& study, const EngineOptions& options, std::vector<StudyRun>& runs,
                  const std::vector<std::size_t>& which, StudyProgress& progress);

/// Returns a path as a file name pattern of sbatch, in which % starts a replacement.
std::string slurm_pattern(const std::string& path);

/// Name of the jobs of a study in Slurm.
std::string slurm_job_name(const std::string& directory);

}  // namespace experiment
