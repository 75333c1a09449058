// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/gil.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace python {
namespace {

std::atomic<bool> ending = false;
std::atomic<int> working = 0;  // threads without the GIL
const pid_t process = getpid();

bool is_main_thread() {
  return gettid() == getpid();
}

/// Keeps a daemon's thread until the process ends.
void stay_if_ending() {
  if (!ending || is_main_thread()) return;
  --working;
  while (true) pause();
}

}  // namespace

WithoutGil::WithoutGil() : state_(nullptr) {
  ++working;
  state_ = PyEval_SaveThread();
}

WithoutGil::~WithoutGil() {
  stay_if_ending();
  PyEval_RestoreThread(state_);
  --working;
}

WithGil::WithGil() : state_(PyGILState_UNLOCKED) {
  stay_if_ending();
  state_ = PyGILState_Ensure();
}

WithGil::~WithGil() {
  PyGILState_Release(state_);
}

bool interpreter_ends() {
  return ending;
}

void end_interpreter(void (*stop)()) {
  using Clock = std::chrono::steady_clock;
  if (getpid() != process) return;
  ending = true;
  stop();
  PyThreadState* const state = PyEval_SaveThread();
  const auto deadline = Clock::now() + std::chrono::seconds(2);
  while (working > 0 && Clock::now() < deadline) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  PyEval_RestoreThread(state);
}

}  // namespace python
