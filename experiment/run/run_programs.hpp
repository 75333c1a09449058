// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "experiment/process/process_group.hpp"
#include "experiment/results/results.hpp"
#include "experiment/run/run_buses.hpp"
#include "sim/world_file/world_config.hpp"

namespace experiment {

/// External programs of a world: starts, awaits and monitors them.
class RunPrograms {
 public:
  /// All except the key must outlive this.  `run_key`: value of SHOAL_RUN_KEY for the programs; empty: none.
  RunPrograms(const sim::WorldConfig& config, const RunOptions& options, RunBuses& buses, std::string run_key);

  /// Starts the programs when the options require it.  Returns the lockstep clients to wait for.  Throws RunError.
  std::vector<std::string> start();
  struct Left {
    std::string reason;  ///< such as an exception; empty: as planned, or it has not left
    double time_s = 0;   ///< simulated
  };
  /// State of lockstep clients, by name.
  struct Clients {
    /// Returns whether the client has left the lockstep.
    std::function<bool(const std::string& client)> has_left;
    /// Handles the end of its process.  Returns whether the run continues without it at once; otherwise its
    /// `on_timeout` applies.
    std::function<bool(const std::string& client)> removed;
    /// Returns why and when the client has left.
    std::function<Left(const std::string& client)> left;
  };

  /// Checks for programs that have ended.  A client that ended before its last tick without leaving, or that left for a
  /// reason, has failed, regardless of its exit code.  Throws RunError when the world requires the run to end with a
  /// program.
  void check(sim::Time now, const Clients& clients);
  /// Records the programs that have already ended, before the end of the run is announced, and those that have left for
  /// a reason.
  void note_last(sim::Time now, const Clients& clients);
  bool is_gone(const std::string& client) const { return removed_.contains(client); }
  /// Waits for the lockstep clients to end by themselves.
  void await_clients() { processes_.await_clients(); }
  void stop() { processes_.stop(); }
  /// Programs that ended before the run did.
  const std::vector<Summary::Process>& ended() const { return ended_; }

 private:
  struct Exit : ProcessGroup::Exit {
    double time_s;  ///< simulated: of the leave, if its client had left for a reason
  };
  std::vector<Exit> reap(sim::Time now, const Clients& clients);
  void note(const Exit& exit);

  const sim::WorldConfig& config_;
  const RunOptions& options_;
  RunBuses& buses_;
  ProcessGroup processes_;
  std::vector<Summary::Process> ended_;
  std::set<std::string, std::less<>> removed_;
};

}  // namespace experiment
