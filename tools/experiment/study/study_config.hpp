// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/world_file/load_world.hpp"

namespace tools {

/// One way of running the world.
struct StudyCase {
  std::string name;
  sim::ConfigNode changes;  ///< dotted path: value, as with --set
  void read(sim::ParamReader& in);
  /// `path=value` of each change.
  std::vector<std::string> sets() const;
};

/// A plot of a study: one figure by case, or errors along the way.
struct StudyPlot {
  enum class Over { cases, distance, time };
  std::string name;
  std::string figure;                ///< by case
  std::vector<std::string> metrics;  ///< whose errors are drawn, with median and the band of 5 to 95 %
  std::vector<std::string> cases;    ///< empty: all
  Over over = Over::cases;
  sim::SourcePlace place;
  void read(sim::ParamReader& in);
};

/// A study file: one world, run with many seeds in several cases.
struct StudyConfig {
  std::string file, name, description;
  std::string world;  ///< path from here
  bool launch = false;
  std::optional<double> duration_s;
  std::vector<std::int64_t> seeds;
  std::vector<StudyCase> cases;
  std::vector<std::string> figures;  ///< of the table; empty: all
  std::vector<StudyPlot> plots;
  std::vector<sim::RuleExpression> pass;  ///< the study passes when every rule holds
  sim::ConfigNode rules;                  ///< `pass:` as it was written, for errors that show with the worlds
  sim::SourcePlace figures_place;

  void read(sim::ParamReader& in);
};

struct LoadedStudy {
  StudyConfig config;
  std::vector<sim::LoadedWorld> worlds;  ///< by case
};

/// What a command line says instead of the file.
struct StudyChanges {
  std::vector<std::int64_t> seeds;  ///< empty: those of the file
  std::optional<double> duration_s;
  sim::LoadOptions load;      ///< which files its worlds may name
  bool only_checked = false;  ///< nothing will run: plugins that the world names are not loaded
};

/// Seeds as a command line gives them: `7`, `1-10` or `1-3,8`.  Throws std::invalid_argument with the rule.
std::vector<std::int64_t> parse_seeds(const std::string& text);

/// Reads and checks a study and its world in every case.  Throws sim::ConfigError.
LoadedStudy load_study(const std::string& path, const StudyChanges& changes = {});

/// A serial port that two runs at the same time would have.
struct SharedPort {
  sim::SourcePlace place;
  std::string who;   ///< vehicle and device
  std::string path;  ///< as the first of them has it
};
/// Runs with `launch` open their serial ports; this one's path has no `{run}`.
std::optional<SharedPort> find_shared_port(const LoadedStudy& study);

}  // namespace tools
