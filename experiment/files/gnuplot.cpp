// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/gnuplot.hpp"

#include <signal.h>
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <thread>

#include "bridges/base/child_program.hpp"

namespace experiment {

namespace {

/// Runs a shell in its own process group: Ctrl-C on the terminal must not reach gnuplot.
pid_t start(const std::string& directory, const std::string& script) {
  // A link in place of the log is removed, not followed.  -d: no init files.
  const std::string command = "cd -- \"$0\" && rm -f plot.log && exec gnuplot -d \"$1\" > plot.log 2>&1 < /dev/null";
  pid_t pid = 0;
  const int error =
      bridges::start_child({"sh", {"sh", "-c", command, directory, script}, bridges::own_environment(), ""}, pid);
  return error == 0 ? pid : 0;
}

/// Processor time of a child; it is kept until waitpid().
std::chrono::nanoseconds cpu_time(pid_t pid) {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &time) != 0) return {};
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace

std::string gnuplot_text(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    quoted += byte < 0x20 || byte == 0x7f ? ' ' : c;
    if (c == '\'') quoted += c;
  }
  return quoted + "'";
}

std::string axis_of_errors(const std::vector<double>& errors_m) {
  constexpr double very_different = 5;
  double min = std::numeric_limits<double>::infinity(), max = 0;
  for (const double error_m : errors_m) {
    min = std::min(min, error_m);
    max = std::max(max, error_m);
  }
  if (!(min > 0) || !(max > very_different * min)) return "set yrange [0:*]\n";
  return fmt::format("set logscale y\nset yrange [{:.3g}:*]\n", 0.05 * min);
}

bool run_gnuplot(const std::string& directory, const std::string& script, std::chrono::milliseconds cpu_limit,
                 const std::function<bool()>& give_up) {
  using Clock = std::chrono::steady_clock;
  const pid_t pid = start(directory, script);
  if (pid == 0) return false;
  // CPU time is limited, since the machine may be busy with other runs; the wall time only ends a gnuplot that waits.
  const auto deadline = Clock::now() + 20 * cpu_limit;
  while (Clock::now() < deadline && cpu_time(pid) < cpu_limit && !give_up()) {
    int status = 0;
    const pid_t ended = waitpid(pid, &status, WNOHANG);
    if (ended == pid) return status == 0;
    if (ended < 0 && errno != EINTR) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  // The whole group: gnuplot may have started helpers.
  kill(-pid, SIGKILL);
  while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
  }
  return false;
}

}  // namespace experiment
