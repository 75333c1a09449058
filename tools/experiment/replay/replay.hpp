// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/world_file/load_world.hpp"
#include "tools/experiment/replay/replay_log.hpp"

namespace tools {

struct ReplayOptions {
  std::string log;
  std::string world;              ///< another world file; empty: the world in the log
  sim::LoadOptions load;          ///< `sets` are applied to it
  std::optional<double> until_s;  ///< simulated time; without it to the end of the log
  int threads = 0;                ///< that follow rays; 0: one for each processor
  bool quiet = false;             ///< no progress
};

/// What came of running a log's world again.
struct ReplayOutcome {
  /// The first step at which something differs, and what: all that differs at this step, messages first.
  struct First {
    std::int64_t step = 0;
    std::vector<std::string> what;
  };

  std::int64_t begin_step = 0;  ///< later than 0 when the log begins with a snapshot
  std::int64_t steps = 0;       ///< that were run
  double sim_time_s = 0, step_s = 0, wall_s = 0;
  std::uint64_t hashes = 0, messages = 0, missing_messages = 0;
  std::optional<First> first;
  std::vector<std::string> world;   ///< how the world here is another one than the log's
  std::string motion;               ///< the first step at which something moves differently; empty: none was seen
  bool complete = true;             ///< the proof holds to the end of the log, or to until_s
  bool interrupted = false;         ///< by a signal
  std::vector<std::string> notes;   ///< what keeps it from being a whole proof, or should be known of the log
  std::vector<std::string> report;  ///< differences in detail

  /// 0: equal; 1: different; 4: equal as far as the log tells, which is not to its end.
  int exit_code() const;
  /// `equal for 90000 steps (901 hashes, 123456 messages)`, or the first difference; then the notes.
  std::string to_text() const;
};

/// Runs the world of a log again, without clients: what came to it from outside is handed over at the same steps, and
/// what it publishes and its state are compared with the log.  Throws std::runtime_error when the log cannot be used,
/// sim::ConfigError when the world cannot be built.
ReplayOutcome replay(const ReplayOptions& options);

}  // namespace tools
