// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

#include "sim/world_file/world_config.hpp"

namespace tools {

/// The external programs of an experiment.  Each gets its own process group, so that its children end with it, and
/// SIGTERM when we are killed.
class ProcessGroup {
 public:
  struct Exit {
    std::string name;
    std::string how;     ///< `exited with code 1`, `was killed by signal 9 (Killed)`
    std::string client;  ///< its lockstep name
    bool ends_run = false;
    bool failed = false;   ///< with an exit code that is not 0, or by a signal
    bool ignored = false;  ///< the world says that this does not matter
  };

  /// `run_key`: what programs get as SHOAL_RUN_KEY; empty: they get none, also not ours.
  explicit ProcessGroup(std::string run_key = {}) : run_key_(std::move(run_key)) {}
  /// Ends what still runs: SIGTERM, and SIGKILL after 2 s.
  ~ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  /// Starts a program; it inherits our output, or writes to LOG_DIRECTORY/NAME.log when that is not empty.
  /// `{lcm_url}` in the arguments is replaced, and LCM_DEFAULT_URL is set.  A program without a slash is looked up
  /// beside the running program, then in PATH.  Throws std::runtime_error when it cannot be started.
  void start(const sim::ProcessConfig& config, const std::string& lcm_url, const std::string& log_directory);
  /// Programs that ended since the last call.
  std::vector<Exit> reap();
  /// Lets those that take part in the lockstep end by themselves, for up to 2 s: they were notified of the end of the
  /// run.
  void await_clients();
  /// Asks all and their children to end, and waits; SIGKILL after 2 s.  Exit codes of programs that were asked do not
  /// matter.
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

/// Whether there is such a program where ProcessGroup::start looks for it.
bool can_be_started(const std::string& program);

}  // namespace tools
