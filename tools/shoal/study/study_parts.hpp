// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "experiment/study/study_runs.hpp"

namespace tools {

/// Returns the folder of a study without `--output`.  A short trial does not overwrite the runs of the whole study.
std::string usual_output(const experiment::LoadedStudy& study, const experiment::StudyChanges& changes);

/// Sets the number of jobs when it is 0.  Throws sim::ConfigError when runs at the same time would share a serial port.
void choose_jobs(const experiment::LoadedStudy& study, experiment::StudyOptions& options);

/// Writes and prints the results of runs that have been executed.  Returns the exit code.  Throws std::runtime_error.
int collect_results(experiment::LoadedStudy& study, std::vector<experiment::StudyRun>& runs, const std::string& output,
                    bool quiet);

/// Adds --jobs, --fresh, --run-timeout and --quiet.
void add_jobs_options(CLI::App& command, experiment::StudyOptions& options);

/// Throws sim::ConfigError when `shoal-nav` does not know an algorithm of a study.
void require_algorithms(const experiment::LoadedStudy& study);

/// Adds --algorithm.
void add_algorithm_option(CLI::App& command, experiment::StudyChanges& changes);

void add_study_run_command(CLI::App& study_command, int& exit_code);
void add_study_collect_command(CLI::App& study_command, int& exit_code);

}  // namespace tools
