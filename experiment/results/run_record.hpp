// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiment/score/rule_verdict.hpp"

namespace experiment {

/// Contents of a results directory, read from its files.
struct RunRecord {
  struct Rule {
    std::string rule;
    bool passed = false;
    std::string result = {};  ///< values of its sides, or why the rule cannot be judged; empty: nothing to add
  };
  struct Process {
    std::string name, how;
    double sim_time_s = 0;
    bool failed = false;
  };
  /// Contact of a vehicle with another vehicle or an object.
  struct Contact {
    std::string vehicle, with;
    double first_s = 0;
    std::int64_t count = 0;
  };

  /// Message that a shadow took.
  struct Shadowed {
    double sent_s = 0;
    std::string from, to;
    double range_m = 0;
  };

  std::string directory;
  std::string world, description;
  std::int64_t seed = 0;
  std::int64_t steps = 0;
  double sim_time_s = 0;
  double wall_s = 0;
  std::string state_hash;
  std::string run_hash;  ///< empty: an older run
  std::int64_t messages = 0, dropped_messages = 0, bad_messages = 0, quick_steps = 0;
  std::int64_t modem_dropped_messages = 0;
  std::map<std::string, std::optional<double>> metrics;  ///< unset: there was no data for the figure
  std::vector<Rule> rules;
  std::vector<Process> processes;
  std::vector<Contact> contacts;   ///< one per pair, in order of time; empty in older runs
  std::vector<Shadowed> shadowed;  ///< the first messages that shadows took
  std::int64_t shadowed_count = 0;
  std::optional<Rule> event;  ///< condition of the event that ended the run
  Judgement judgement = Judgement::not_judged;
  std::string not_judged;  ///< reason; empty when it was judged
  std::string ended, error;
  int exit_code = 0;
  std::string version;  ///< of shoal; empty: an older one without this field
  std::string build;    ///< processor class and C library; empty: an older run
};

/// Reads DIRECTORY/summary.json.  Throws std::runtime_error with file and reason when it does not exist, is not JSON,
/// or has a value of a wrong type.
RunRecord read_run(const std::string& directory);

/// Reads a file of at most 64 MB.  Throws std::runtime_error.
std::string read_whole_file(const std::string& path);

}  // namespace experiment
