// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "shoal/sim_info_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"
#include "tools/experiment/snapshot/snapshot_file.hpp"

namespace tools {

/// What a log of a run holds beside the messages themselves: all that is needed to run the world again.
struct ReplayLog {
  /// See sim_letter_t.
  struct Letter {
    std::int64_t step = 0;
    std::string bus, channel;
    sim::Bytes payload;
  };
  struct Hashes {
    std::uint64_t whole = 0;
    std::vector<sim::PartHash> parts;
    bool after_letters = false;        ///< letters of its own step came before it, as at the end of a run
    std::optional<std::uint64_t> run;  ///< of the run up to here; unset: the version that wrote it did not tell
  };

  std::string path;
  shoal::sim_info_t info{};                 ///< the first
  std::optional<Snapshot> snapshot;         ///< that it begins with; letters and hashes are of later
  std::string bad_snapshot;                 ///< why one that it began with cannot be used; empty: none was bad
  std::vector<Letter> letters;              ///< in the order in which they were handed over
  std::map<std::int64_t, Hashes> hashes;    ///< by step
  std::int64_t first_step = 0;              ///< of which the log tells
  std::int64_t last_step = 0;               ///< the last one of which the log is known to hold all letters and messages
  std::string cut;                          ///< what stands behind last_step and is left out, in words; empty: nothing
  std::optional<std::int64_t> proven_step;  ///< up to which all letters are there; unset: all of them are
  std::vector<std::string> holes;           ///< letters that are missing, in words
  std::vector<std::string> notices;         ///< what sim.notice says, in words: the first ones
  std::vector<std::string> problems;        ///< damage, and messages that cannot be read
  std::map<std::string, std::uint64_t> events;  ///< by channel
  bool own_stamps = true;                       ///< stamped with simulated time: a record, in which nothing is lost
  bool goes_back = false;                       ///< holds the same steps more than once, of several branches

  /// Where the repetition begins.
  std::int64_t begin_step() const { return snapshot ? snapshot->step : 0; }
  /// The last step up to which the run can be repeated.
  std::int64_t usable_step() const { return proven_step.value_or(last_step); }
};

/// Reads a log once.  Throws std::runtime_error: it cannot be read, is no log of a run, holds two runs, or its stamps
/// are not those of its run.
ReplayLog read_replay_log(const std::string& path);

}  // namespace tools
