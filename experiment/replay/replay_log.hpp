// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiment/snapshot/snapshot_file.hpp"
#include "shoal/sim_info_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"

namespace experiment {

/// Content of a log of a run without the messages: everything needed to replay the world.
struct ReplayLog {
  /// Message delivered to the world; see sim_input_t.
  struct Input {
    std::int64_t step = 0;
    std::string bus, channel;
    sim::Bytes payload;
  };
  struct Hashes {
    std::uint64_t whole = 0;
    std::vector<sim::PartHash> parts;
    bool after_inputs = false;         ///< inputs of its own step precede it, as at the end of a run
    std::optional<std::uint64_t> run;  ///< hash of the run up to here; unset: the version that wrote the log did not
                                       ///< record it
  };

  std::string path;
  shoal::sim_info_t info{};                 ///< the first
  std::optional<Snapshot> snapshot;         ///< with which the log starts; inputs and hashes are later
  std::string bad_snapshot;                 ///< why the snapshot at its start cannot be used; empty: it is usable, or
                                            ///< there is none
  std::vector<Input> inputs;                ///< in the order of delivery
  std::map<std::int64_t, Hashes> hashes;    ///< by step
  std::int64_t first_step = 0;              ///< first step that the log covers
  std::int64_t last_step = 0;               ///< the last one for which the log has all inputs and messages
  std::string cut;                          ///< description of what follows last_step and is left out; empty: nothing
  std::optional<std::int64_t> proven_step;  ///< up to which all inputs are present; unset: all of them
  std::vector<std::string> holes;           ///< description of the missing inputs
  std::vector<std::string> audit;           ///< text of the first sim.audit messages
  std::vector<std::string> problems;        ///< damage, and messages that cannot be read
  std::map<std::string, std::uint64_t> events;  ///< by channel
  bool own_stamps = true;                       ///< time stamps are simulated time: a record without losses
  bool is_thinned = false;                      ///< a record within a budget: messages were left out
  bool is_rewound = false;                      ///< holds the same steps more than once, from several branches

  /// Step at which the repetition starts.
  std::int64_t begin_step() const { return snapshot ? snapshot->step : 0; }
  /// Last step up to which the run can be repeated.
  std::int64_t usable_step() const { return proven_step.value_or(last_step); }
};

/// Reads a log in one pass.  Throws std::runtime_error when it cannot be read, is not a log of a run, contains two
/// runs, or has time stamps that do not match its run.
ReplayLog read_replay_log(const std::string& path);

}  // namespace experiment
