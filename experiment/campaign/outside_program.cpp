// SPDX-License-Identifier: BSD-3-Clause
#include <signal.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "bridges/base/child_program.hpp"
#include "experiment/campaign/engines.hpp"
#include "experiment/files/scratch_directory.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/results/run_record.hpp"

namespace experiment {

namespace {

constexpr std::chrono::milliseconds poll_interval{5};
constexpr std::chrono::milliseconds signal_interval{300};

int exit_code_of(int status) {
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// Starts a program from PATH.  Throws std::runtime_error.
pid_t start_outside(const std::vector<std::string>& arguments, const std::string& log) {
  pid_t pid = 0;
  if (const int error = bridges::start_child({arguments.front(), arguments, bridges::own_environment(), log}, pid);
      error != 0)
    throw std::runtime_error("cannot start '" + arguments.front() + "': " + std::strerror(error));
  return pid;
}

}  // namespace

void require_program(const std::string& name, const std::string& package) {
  if (bridges::is_program(name)) return;
  throw std::runtime_error("there is no program '" + name + "' in PATH; Debian has it in the package " + package);
}

ProgramOutput output_of(const std::vector<std::string>& arguments) {
  const ScratchDirectory folder;
  const std::string log = (folder.path / "output").string();
  const pid_t pid = start_outside(arguments, log);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return {exit_code_of(status), read_whole_file(log)};
}

int run_outside_program(const std::vector<std::string>& arguments) {
  const pid_t pid = start_outside(arguments, "");
  int status = 0, passed_on = 0;
  auto next = std::chrono::steady_clock::now();
  while (waitpid(pid, &status, WNOHANG) != pid) {
    // GNU parallel waits for its jobs after the first one, and ends them after the second.
    if (caught_signals() > 0 && passed_on < 2 && std::chrono::steady_clock::now() >= next) {
      ++passed_on;
      kill(-pid, SIGTERM);
      next = std::chrono::steady_clock::now() + signal_interval;
    }
    std::this_thread::sleep_for(poll_interval);
  }
  return exit_code_of(status);
}

std::string own_program() {
  return std::filesystem::canonical("/proc/self/exe").string();
}

}  // namespace experiment
