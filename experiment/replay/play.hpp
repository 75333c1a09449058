// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace experiment {

struct PlayOptions {
  std::string log;                 ///< a record of shoal run --record
  std::string lcm_url;             ///< empty: LCM_DEFAULT_URL, then the default
  std::vector<std::string> await;  ///< lockstep clients to wait for; empty: any
  double join_timeout_s = 30;      ///< wall time to wait for them; 0: none
  std::optional<double> until_s;   ///< simulated time; without it to the end of the record
  double speed = 0;                ///< times real time; 0: as fast as possible
  bool compare = false;            ///< answers that differ from the record are an error
  bool quiet = false;              ///< prints no progress
};

/// Result of the playback of a record.
struct PlayOutcome {
  std::string text;   ///< human-readable lines
  int exit_code = 0;  ///< 0, or 1 when `compare` found a difference; 128 + signal when a signal ended the playback
};

/// Plays the messages of a record back to programs as its run did, without a world: in lockstep to those that join,
/// each at its own period, and on the bus to those that only listen.  Messages that the programs publish have no
/// effect; they are compared with the record.  Throws RunError: 2 options, 4 bus (also another simulator on it) or
/// record, 5 no client joined, or one did not answer.
PlayOutcome play(const PlayOptions& options);

}  // namespace experiment
