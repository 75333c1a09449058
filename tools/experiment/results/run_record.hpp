// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/experiment/score/judgement.hpp"

namespace tools {

/// What a results directory reports its run, read again.
struct RunRecord {
  struct Rule {
    std::string rule;
    bool passed = false;
    std::string result = {};  ///< what its sides came to, or why there is nothing to judge; empty: nothing to add
  };
  struct Process {
    std::string name, how;
    double sim_time_s = 0;
    bool failed = false;
  };
  /// Of a vehicle with another one, or with an object.
  struct Contact {
    std::string vehicle, with;
    double first_s = 0;
    std::int64_t count = 0;
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
  std::map<std::string, std::optional<double>> metrics;  ///< unset: there was nothing to make the figure of
  std::vector<Rule> rules;
  std::vector<Process> processes;
  std::vector<Contact> contacts;  ///< a pair each, in order of time; empty in older runs
  std::optional<Rule> event;      ///< what the event said that ended the run
  Judgement judgement = Judgement::not_judged;
  std::string not_judged;  ///< why it was not; empty when it was
  std::string ended, error;
  int exit_code = 0;
  std::string version;  ///< of shoal; empty: an older one without this field
};

/// Reads DIRECTORY/summary.json.  Throws std::runtime_error with file and reason: it does not exist, no JSON, or a
/// value is of a wrong type.
RunRecord read_run(const std::string& directory);

/// A file of at most 64 MB.  Throws std::runtime_error.
std::string read_whole_file(const std::string& path);

}  // namespace tools
