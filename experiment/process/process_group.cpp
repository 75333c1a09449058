// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/process_group.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "bridges/base/child_program.hpp"
#include "bridges/signing/run_key.hpp"
#include "sim/config/file_access.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds time_to_end{2};

/// Prefers a program of the same installation or build, so that a build tree works without installation.
std::string find_program(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  std::error_code error;
  const fs::path beside = fs::path(sim::program_folder()) / name;
  return beside.has_parent_path() && fs::exists(beside, error) ? beside.string() : name;
}

std::vector<std::string> environment_with(const std::string& lcm_url, const std::string& run_key) {
  const std::string key_entry = std::string(bridges::run_key_variable) + "=";
  std::vector<std::string> environment = bridges::own_environment();
  std::erase_if(environment, [&](const std::string& entry) {
    return entry.starts_with("LCM_DEFAULT_URL=") || entry.starts_with(key_entry);
  });
  environment.push_back("LCM_DEFAULT_URL=" + lcm_url);
  if (!run_key.empty()) environment.push_back(key_entry + run_key);
  return environment;
}

std::string describe_status(int status) {
  if (WIFEXITED(status)) return "exited with code " + std::to_string(WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  return "was killed by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
}

}  // namespace

bool can_be_started(const std::string& program) {
  return bridges::is_program(find_program(program));
}

ProcessGroup::~ProcessGroup() {
  stop();
}

void ProcessGroup::start(const sim::ProcessConfig& config, const std::string& lcm_url,
                         const std::string& log_directory) {
  std::vector<std::string> arguments = config.command;
  if (arguments.empty())
    throw std::runtime_error("process '" + config.name + "': the declaration of its program was not read");
  arguments[0] = find_program(arguments[0]);
  for (std::string& argument : arguments)
    for (std::size_t at = argument.find("{lcm_url}"); at != std::string::npos; at = argument.find("{lcm_url}"))
      argument.replace(at, 9, lcm_url);
  const std::string log = log_directory.empty() ? "" : log_directory + "/" + config.name + ".log";
  pid_t pid = 0;
  const int error = bridges::start_child({arguments[0], arguments, environment_with(lcm_url, run_key_), log}, pid);
  if (error != 0)
    throw std::runtime_error("process '" + config.name + "': cannot start '" + arguments[0] +
                             "': " + std::strerror(error));
  running_.push_back({pid, config});
}

std::vector<ProcessGroup::Exit> ProcessGroup::reap() {
  std::vector<Exit> exits;
  std::erase_if(running_, [&](const Running& process) {
    int status = 0;
    if (waitpid(process.pid, &status, WNOHANG) != process.pid) return false;
    const bool failed = !WIFEXITED(status) || WEXITSTATUS(status) != 0;
    exits.push_back({process.config.name, describe_status(status), process.config.client,
                     process.config.on_exit == sim::OnExit::end_run, failed,
                     process.config.on_exit == sim::OnExit::ignore});
    if (kill(-process.pid, SIGTERM) == 0) left_behind_.push_back(process.pid);  // its children still run
    return true;
  });
  // The number of a group without members may be reused by another one.
  std::erase_if(left_behind_, [](pid_t group) { return kill(-group, 0) != 0; });
  return exits;
}

void ProcessGroup::signal_all(int signal) const {
  for (const Running& process : running_) kill(-process.pid, signal);
  for (const pid_t group : left_behind_) kill(-group, signal);
}

void ProcessGroup::await_clients() {
  const auto deadline = Clock::now() + time_to_end;
  const auto is_client = [](const Running& process) { return !process.config.client.empty(); };
  while (reap(), std::any_of(running_.begin(), running_.end(), is_client) && Clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

void ProcessGroup::stop() {
  reap();
  signal_all(SIGTERM);
  const auto deadline = Clock::now() + time_to_end;
  while (!empty() && Clock::now() < deadline) {
    reap();
    if (!empty()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  // A process that ignores SIGTERM must not outlive the run.
  signal_all(SIGKILL);
  for (const Running& process : running_)
    while (waitpid(process.pid, nullptr, 0) < 0 && errno == EINTR) {
    }
  running_.clear();
  left_behind_.clear();
}

}  // namespace experiment
