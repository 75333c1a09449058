// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "experiment/results/run_record.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

struct LoadedStudy;
struct StudyRun;

/// Figures of an algorithm of `shoal-nav` on the record of a run, over the vehicles that have a metric `bound`, from
/// its `from_s` on: LABEL.rms_m and so on.
struct AlgorithmFigure {
  const char* name;
  const char* unit;
  const char* meaning;
};
const std::vector<AlgorithmFigure>& algorithm_figures();
/// The figure that differs between equal runs.
inline constexpr const char* time_of_event = "us_per_event";

/// Returns the name of an algorithm in figures: its own, or the class of `python:FILE.Class`.
std::string algorithm_label(const std::string& algorithm);
/// Whether a name may be one: letters, digits and _.
bool is_algorithm_label(const std::string& name);
/// Returns the text of the file of `python:FILE.Class`, on which the results depend; empty for other algorithms.
std::string source_of(const std::string& algorithm);
/// Returns `LABEL.FIGURE` of all algorithms.
std::vector<std::string> figures_of_algorithms(const std::vector<std::string>& algorithms);

/// Scored vehicle of a world: its metric `bound`.
struct ScoredVehicle {
  std::string vehicle, bound;  ///< `bound`: name of the metric
};
/// Vehicles and period that are scored in a world.
struct AlgorithmScoring {
  std::vector<ScoredVehicle> vehicles;
  double from_s = 0;
};
/// Returns what the metrics `bound` of a world score; the last one counts for each vehicle.  Throws sim::ConfigError
/// when there is none, when they differ in `from_s`, or when a metric has the name of an algorithm.
AlgorithmScoring algorithm_scoring(const sim::WorldConfig& world, const std::vector<std::string>& algorithms,
                                   const sim::SourcePlace& place);

/// Path of `shoal-nav`, beside this program.
std::string algorithm_program();

/// Files of the algorithms in the folder of a run.
std::string record_of(const StudyRun& run);
std::string algorithm_scores_of(const StudyRun& run);

/// Returns the arguments of `shoal-nav` that navigates the record of a run.
std::vector<std::string> arguments_of_algorithms(const LoadedStudy& study, const StudyRun& run);

/// Adds the figures of the algorithms to the record of a run, from the file that `shoal-nav` has written.  Throws
/// std::runtime_error with the file and what is wrong.
void add_algorithm_figures(const LoadedStudy& study, StudyRun& run);

}  // namespace experiment
