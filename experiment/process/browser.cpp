// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/browser.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <mutex>

#include "bridges/base/child_program.hpp"
#include "sim/base/log.hpp"

namespace experiment {

namespace {

constexpr std::string_view place_of_url = "%s";

/// Waits for the end of a program, and warns if it has failed.
void watch(const std::stop_token& stop, pid_t pid, const std::string& program) {
  constexpr std::chrono::milliseconds tick{100};
  std::mutex mutex;
  std::condition_variable_any stopped;
  int status = 0;
  while (!stop.stop_requested()) {
    const pid_t ended = waitpid(pid, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) return;
    if (ended == pid) {
      if (WIFEXITED(status) && WEXITSTATUS(status) != 0)
        sim::log_warn("--open: '{}' ended with exit code {}; open the address by hand", program, WEXITSTATUS(status));
      return;
    }
    std::unique_lock lock(mutex);
    stopped.wait_for(lock, stop, tick, [] { return false; });
  }
}

}  // namespace

std::vector<std::string> browser_command(std::string_view browser, const std::string& url) {
  std::vector<std::string> command;
  browser = browser.substr(0, browser.find(':'));
  // Split at spaces.
  while (!browser.empty()) {
    const std::size_t end = std::min(browser.find(' '), browser.size());
    if (end > 0) command.emplace_back(browser.substr(0, end));
    browser.remove_prefix(std::min(end + 1, browser.size()));
  }
  if (command.empty()) return {"xdg-open", url};
  // Insert the address.
  bool inserted = false;
  for (auto word = command.begin() + 1; word != command.end(); ++word)
    if (const std::size_t at = word->find(place_of_url); at != std::string::npos) {
      word->replace(at, place_of_url.size(), url);
      inserted = true;
    }
  if (!inserted) command.push_back(url);
  return command;
}

void Browser::open(const std::string& url) {
  const char* browser = std::getenv("BROWSER");
  const std::vector<std::string> command = browser_command(browser == nullptr ? "" : browser, url);
  // The browser's output is discarded: ours may be data, and browsers write a lot for as long as they run.
  bridges::ChildProgram program{command[0], command, bridges::own_environment(), "/dev/null"};
  program.stays = true;
  pid_t pid = 0;
  if (const int error = bridges::start_child(program, pid); error != 0)
    sim::log_warn("--open: cannot start '{}': {}; open the address by hand", command[0], std::strerror(error));
  else
    watch_ = std::jthread([pid, program = command[0]](const std::stop_token& stop) { watch(stop, pid, program); });
}

}  // namespace experiment
