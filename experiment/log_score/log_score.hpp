// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiment/score/metric.hpp"
#include "experiment/score/rule_verdict.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

struct LogScoreOptions {
  std::string log;
  sim::LoadOptions load;  ///< its `sets` are applied to the world
  int threads = 0;        ///< threads that share a step; 0: one for each processor
  bool quiet = false;     ///< prints no progress
  std::string estimate;   ///< file of EstimateFile; empty: what the programs of the run published
  std::string metric;     ///< whose vehicle the file is of, and whose place it takes; empty: the only position_error
  std::string tum;        ///< folder for TUM files; empty: none
  std::string mrclam;     ///< folder for MR.CLAM files; empty: none
};

/// Scores of a log.
struct LogScore {
  std::string world;
  std::int64_t seed = 0;
  double sim_time_s = 0;
  Figures figures;
  std::vector<RuleVerdict> verdicts;
  std::vector<std::string> notes;  ///< limits of the score
  bool interrupted = false;        ///< by a signal

  std::string to_text() const;
  std::string to_json() const;
};

/// Runs the world of a log again, as replay() does, and scores it by its metrics and rules: with the same figures as
/// in the run, or with those of estimates from a file.  Throws std::runtime_error when the log cannot be used or a file
/// cannot be written, std::invalid_argument for a metric that the world lacks, sim::ConfigError for errors in the world
/// or the file.
LogScore score_log(const LogScoreOptions& options);

}  // namespace experiment
