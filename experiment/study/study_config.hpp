// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment/study/study_design.hpp"
#include "experiment/study/study_until.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/world_file/rule_expression.hpp"

namespace experiment {

/// Variant of the world of a study, or one of its worlds.
struct StudyCase {
  std::string name;
  std::string world;  ///< path relative to the working directory; until the study is loaded, as it is written
  sim::SourcePlace world_place;
  sim::ConfigNode changes;  ///< dotted path: value, as with --set
  void read(sim::ParamReader& in);
  /// Returns `path=value` of each change.
  std::vector<std::string> sets() const;
};

/// Plot of a study: one figure by case, or errors over distance or time.
struct StudyPlot {
  enum class Over { cases, distance, time };
  std::string name;
  std::string figure;                ///< by case
  std::vector<std::string> metrics;  ///< metrics whose errors are drawn, with median and the band of 5 to 95 %
  std::vector<std::string> cases;    ///< empty: all
  Over over = Over::cases;
  sim::SourcePlace place;
  void read(sim::ParamReader& in);
};

/// Study file: a world, run with many seeds in several cases, or several worlds, each of which is a case.
struct StudyConfig {
  std::string file, name, description;
  bool launch = false;
  std::optional<double> duration_s;
  std::vector<std::int64_t> seeds;
  std::vector<StudyCase> cases;
  bool of_worlds = false;                     ///< the cases have different worlds
  std::vector<std::string> algorithms;        ///< of `shoal-nav`, which navigate the record of each run
  std::vector<std::string> added_algorithms;  ///< those of them that are not in the file
  std::string pairs;                          ///< label of the algorithm that the others are compared with; empty: none
  std::vector<StudyFactor> factors;
  StudyDesign design;                ///< of the factors
  std::optional<StudyUntil> until;   ///< the study ends when its result is certain; unset: after all seeds
  std::vector<std::string> figures;  ///< of the table; empty: all
  std::vector<StudyPlot> plots;
  std::vector<sim::RuleExpression> pass;  ///< the study passes when every rule holds
  sim::ConfigNode rules;                  ///< `pass:` as written, for errors that are found only with the worlds
  sim::SourcePlace figures_place, algorithms_place;

  void read(sim::ParamReader& in);
  /// Returns the path of its world, or `N worlds`.
  std::string world_text() const;

 private:
  void read_worlds(sim::ParamReader& in);
  void read_algorithms(sim::ParamReader& in);
  void check_design(sim::ParamReader& in) const;
};

/// Reads the key `seeds`: numbers, ranges such as 1-10, or a map of first and count.
std::vector<std::int64_t> read_seeds(sim::ParamReader& in);

/// Parses the seeds of a command line: `7`, `1-10` or `1-3,8`.  Throws std::invalid_argument with the rule.
std::vector<std::int64_t> parse_seeds(const std::string& text);

}  // namespace experiment
