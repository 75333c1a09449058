// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

#include "sim/world_file/world_config.hpp"

namespace experiment {

/// External programs of an experiment.  Each gets its own process group, so that its children end with it, and SIGTERM
/// when this process is killed.
class ProcessGroup {
 public:
  struct Exit {
    std::string name;
    std::string how;     ///< `exited with code 1`, `was killed by signal 9 (Killed)`
    std::string client;  ///< name in the lockstep
    bool ends_run = false;
    bool failed = false;   ///< with an exit code that is not 0, or by a signal
    bool ignored = false;  ///< the world declares the end of this program as irrelevant
  };

  /// `run_key`: value of SHOAL_RUN_KEY for the programs; empty: they get none, and do not inherit ours.
  explicit ProcessGroup(std::string run_key = {}) : run_key_(std::move(run_key)) {}
  /// Ends all running programs: SIGTERM, and SIGKILL after 2 s.
  ~ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  /// Starts a program; it inherits our output, or writes to LOG_DIRECTORY/NAME.log when that is not empty. Replaces
  /// `{lcm_url}` in the arguments and sets LCM_DEFAULT_URL.  A program without a slash is looked up in the folder of
  /// the running program, then in PATH.  Throws std::runtime_error when it cannot be started.
  void start(const sim::ProcessConfig& config, const std::string& lcm_url, const std::string& log_directory);
  /// Returns the programs that ended since the last call.
  std::vector<Exit> reap();
  /// Waits up to 2 s for lockstep clients to end by themselves, after they were notified of the end of the run.
  void await_clients();
  /// Sends SIGTERM to all programs and their children, and waits; SIGKILL after 2 s.  Ignores the exit codes of these
  /// programs.
  void stop();
  bool empty() const { return running_.empty() && left_behind_.empty(); }

 private:
  struct Running {
    pid_t pid;
    sim::ProcessConfig config;
  };
  void signal_all(int signal) const;

  const std::string run_key_;
  std::vector<Running> running_;
  std::vector<pid_t> left_behind_;  ///< process groups that outlive their programs
};

/// Returns whether ProcessGroup::start finds such a program.
bool can_be_started(const std::string& program);

}  // namespace experiment
