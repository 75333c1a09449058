#include "tools/experiment/terminal_keys.hpp"

#include <poll.h>
#include <signal.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>

namespace tools {

namespace {

// Signal handlers have no other way to know them.
termios before{}, raw{};
std::atomic<bool> active{false};

bool in_foreground() {
  return tcgetpgrp(STDIN_FILENO) == getpgrp();
}

void use(const termios& settings) {
  if (in_foreground()) tcsetattr(STDIN_FILENO, TCSANOW, &settings);
}

void on_stop(int) {
  use(before);
  // SIGSTOP rather than SIGTSTP once more: it needs no handler put away and back again.
  raise(SIGSTOP);
}

void on_continue(int) {
  use(raw);
}

void on_death(int signal) {
  use(before);
  raise(signal);  // SA_RESETHAND: as if it had not been caught
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
  return isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0 && tcgetattr(STDIN_FILENO, &before) == 0;
}

TerminalKeys::TerminalKeys() {
  if (tcgetattr(STDIN_FILENO, &before) != 0) return;
  raw = before;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C and Ctrl-Z stay signals
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  active = true;
  handle(SIGTSTP, on_stop, SA_RESTART);
  handle(SIGCONT, on_continue, SA_RESTART);
  for (const int signal : deadly) handle(signal, on_death, SA_RESETHAND | SA_NODEFER);
  use(raw);
}

TerminalKeys::~TerminalKeys() {
  if (!active) return;
  for (const int signal : {SIGTSTP, SIGCONT}) handle(signal, SIG_DFL, 0);
  for (const int signal : deadly) handle(signal, SIG_DFL, 0);
  active = false;
  use(before);
}

std::optional<char> TerminalKeys::next() {
  if (!active || !in_foreground()) return std::nullopt;
  pollfd waiting{STDIN_FILENO, POLLIN, 0};
  if (poll(&waiting, 1, 0) <= 0 || (waiting.revents & POLLIN) == 0) return std::nullopt;
  char key = 0;
  if (read(STDIN_FILENO, &key, 1) != 1) return std::nullopt;
  return key;
}

}  // namespace tools
