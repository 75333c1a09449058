// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment/replay/replay_log.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

struct ReplayOptions {
  std::string log;
  std::string world;              ///< another world file; empty: the world in the log
  sim::LoadOptions load;          ///< its `sets` are applied to the world
  std::optional<double> until_s;  ///< simulated time; without it to the end of the log
  int threads = 0;                ///< threads that share a step; 0: one for each processor
  bool quiet = false;             ///< prints no progress
};

/// Result of replaying the world of a log.
struct ReplayOutcome {
  /// First step with a difference, and all differences at this step, messages first.
  struct First {
    std::int64_t step = 0;
    std::vector<std::string> what;
  };

  std::int64_t begin_step = 0;  ///< later than 0 when the log begins with a snapshot
  std::int64_t steps = 0;       ///< steps that were run
  double sim_time_s = 0, step_s = 0, wall_s = 0;
  std::uint64_t hashes = 0, messages = 0, missing_messages = 0;
  std::optional<First> first;
  std::vector<std::string> world;   ///< differences between this world and that of the log
  std::string motion;               ///< first step with a different motion; empty: none
  bool complete = true;             ///< the proof extends to the end of the log, or to until_s
  bool interrupted = false;         ///< by a signal
  std::vector<std::string> notes;   ///< limits of the proof, and properties of the log that matter for it
  std::vector<std::string> report;  ///< differences in detail

  /// 0: equal; 1: different; 4: equal as far as the log is usable, which is not to its end.
  int exit_code() const;
  /// Returns `equal for 90000 steps (901 hashes, 123456 messages)`, or the first difference; then the notes.
  std::string to_text() const;
};

/// Replays the world of a log, without clients: the recorded inputs are delivered at the same steps, and the messages
/// and the state of the world are compared with the log.  Throws std::runtime_error when the log cannot be used,
/// sim::ConfigError when the world cannot be built.
ReplayOutcome replay(const ReplayOptions& options);

}  // namespace experiment
