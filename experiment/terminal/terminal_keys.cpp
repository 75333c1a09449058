// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/terminal/terminal_keys.hpp"

#include <poll.h>
#include <signal.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <chrono>

namespace experiment {

namespace {

using Clock = std::chrono::steady_clock;

// Global variables, because signal handlers have no other access.  One copy of the original settings is in use while
// the other is written.
termios before[2]{};
std::atomic<int> in_use{0};
termios raw{};
std::atomic<bool> active{false};

/// Interval between checks of the settings of the terminal.
constexpr std::chrono::milliseconds check_interval{50};

bool in_foreground() {
  return tcgetpgrp(STDIN_FILENO) == getpgrp();
}

void use(const termios& settings) {
  if (in_foreground()) tcsetattr(STDIN_FILENO, TCSANOW, &settings);
}

void use_before() {
  use(before[in_use]);
}

/// Enables single keys without echo; Ctrl-C and Ctrl-Z remain signals.
void take_over() {
  termios now{};
  if (tcgetattr(STDIN_FILENO, &now) != 0 || (now.c_lflag & (ICANON | ECHO)) == 0) return;
  before[1 - in_use] = now;
  in_use = 1 - in_use;
  raw = now;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  tcsetattr(STDIN_FILENO, TCSANOW, &raw);
}

void on_stop(int) {
  use_before();
  // SIGSTOP instead of SIGTSTP, because it needs no change of the handler.
  raise(SIGSTOP);
}

void on_death(int signal) {
  use_before();
  raise(signal);  // SA_RESETHAND: default action
}

void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

constexpr int deadly[] = {SIGQUIT, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL};

}  // namespace

bool TerminalKeys::possible() {
  return isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0 && tcgetattr(STDIN_FILENO, &before[in_use]) == 0;
}

TerminalKeys::TerminalKeys() {
  if (tcgetattr(STDIN_FILENO, &before[in_use]) != 0) return;
  active = true;
  handle(SIGTSTP, on_stop, SA_RESTART);
  for (const int signal : deadly) handle(signal, on_death, SA_RESETHAND | SA_NODEFER);
  if (in_foreground()) take_over();
}

TerminalKeys::~TerminalKeys() {
  if (!active) return;
  handle(SIGTSTP, SIG_DFL, 0);
  for (const int signal : deadly) handle(signal, SIG_DFL, 0);
  active = false;
  use_before();
}

void TerminalKeys::restore_saved() {
  if (active) use_before();
}

std::optional<char> TerminalKeys::next() {
  if (!active) return std::nullopt;
  // A shell moves a job to the foreground with its own settings, possibly without a signal.
  if (const auto now = Clock::now(); now >= check_at_) {
    check_at_ = now + check_interval;
    if (in_foreground()) take_over();
  }
  pollfd waiting{STDIN_FILENO, POLLIN, 0};
  if (poll(&waiting, 1, 0) <= 0 || (waiting.revents & POLLIN) == 0 || !in_foreground()) return std::nullopt;
  char key = 0;
  if (read(STDIN_FILENO, &key, 1) != 1) return std::nullopt;
  return key;
}

}  // namespace experiment
