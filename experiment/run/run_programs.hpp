// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "bridges/control/sim_service.hpp"
#include "experiment/process/process_group.hpp"
#include "experiment/results/results.hpp"
#include "experiment/run/run_parts.hpp"

namespace experiment {

/// External programs of a world: starts, awaits and monitors them.
class RunPrograms {
 public:
  /// All except the key must outlive this.  `time` executes requests about simulated time; `run_key`: value of
  /// SHOAL_RUN_KEY for the programs; empty: none.
  RunPrograms(const RunOptions& options, RunParts& parts, bridges::TimeMachine& time, std::string run_key);

  /// Starts the programs when the options require it.  Returns the lockstep clients to wait for.  Throws RunError.
  std::vector<std::string> start();
  /// Checks for programs that have ended.  A client that ended before its last tick without leaving, or that left for a
  /// reason, has failed, regardless of its exit code.  Executes the requests that wait, the last of which may be to
  /// leave.  `before_report` is called before a line is logged.  Throws RunError when the world requires the run to end
  /// with a program.
  void check(const std::function<void()>& before_report = {});
  /// Records the programs that have already ended, before the end of the run is announced, and those that have left for
  /// a reason.
  void note_last();
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
  /// `requests_count`: those that wait are executed.
  std::vector<Exit> reap(bool requests_count);
  void note(const Exit& exit);

  const RunOptions& options_;
  RunParts& parts_;
  bridges::TimeMachine& time_;
  ProcessGroup processes_;
  std::vector<Summary::Process> ended_;
  std::set<std::string, std::less<>> removed_;
};

}  // namespace experiment
