// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/signals.hpp"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <atomic>

#include "experiment/terminal/terminal_keys.hpp"

namespace experiment {

namespace {

std::atomic<int> signal_caught{0};

std::atomic<int> signals_caught{0};

std::atomic<int> orderly_ends{0};
std::atomic<long long> first_at_ms{0};

long long now_ms() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1000LL * now.tv_sec + now.tv_nsec / 1'000'000;
}

/// Ends the program without executing any of its own code, which may hang.
[[noreturn]] void end_at_once(int signal) {
  TerminalKeys::restore_saved();
  constexpr char text[] = "\nshoal: ended by another signal: unwritten data is lost\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
  _exit(128 + signal);
}

/// One Ctrl-C may arrive as several signals: from the terminal, from a shell and from `timeout`.
constexpr long long one_request_ms = 500;

void on_signal(int signal) {
  const int before = signals_caught++;
  if (before == 0) {
    first_at_ms = now_ms();
    signal_caught = signal;
    return;
  }
  if (now_ms() - first_at_ms < one_request_ms) return;
  // While the results are written, the second signal skips the plots, and only a third one ends the program.
  const int needed = orderly_ends > 0 ? 3 : 2;
  if (before + 1 >= needed) end_at_once(signal);
}

}  // namespace

void catch_signals(bool ignore_pipe) {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (signal == SIGHUP && before.sa_handler == SIG_IGN) continue;  // nohup
    sigaction(signal, &action, nullptr);
  }
  struct sigaction of_pipe {};
  sigaction(SIGPIPE, nullptr, &of_pipe);
  if (ignore_pipe && of_pipe.sa_handler == SIG_DFL) ::signal(SIGPIPE, SIG_IGN);
}

OrderlyEnd::OrderlyEnd() {
  ++orderly_ends;
}

OrderlyEnd::~OrderlyEnd() {
  --orderly_ends;
}

int caught_signal() {
  return signal_caught;
}

int caught_signals() {
  return signals_caught;
}

}  // namespace experiment
