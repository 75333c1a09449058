#include "tools/experiment/signals.hpp"

#include <signal.h>

#include <atomic>

namespace tools {

namespace {

std::atomic<int> signal_caught{0};

std::atomic<int> signals_caught{0};

void on_signal(int signal) {
  signal_caught = signal;
  ++signals_caught;
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

int caught_signal() {
  return signal_caught;
}

int caught_signals() {
  return signals_caught;
}

}  // namespace tools
