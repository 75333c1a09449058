// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/base/time.hpp"

namespace sim {

/// Requests of users and programs to a run.
struct RunControl {
  bool paused = false;
  bool quit = false;
  double speed = 0;                 ///< times real time; 0: as fast as possible
  std::int64_t single_steps = 0;    ///< steps to take while paused
  std::int64_t changes = 0;         ///< number of changes of paused and speed, after which pacing restarts
  std::int64_t pause_requests = 0;  ///< number of requests to pause, resume or step
  std::optional<Time> until;        ///< the run pauses at the first step at or after this
  std::string until_event;          ///< the run pauses when this event has fired; empty: none
  std::int64_t until_firings = 0;   ///< number of its firings before the request
  std::int32_t branch = 0;          ///< increases with every rewind and restore

  bool may_step() const { return !quit && (!paused || single_steps > 0); }
  void step_taken() {
    if (paused && single_steps > 0) --single_steps;
  }
  void set_paused(bool pause) {
    paused = pause;
    ++pause_requests;
    single_steps = 0;
    ++changes;
  }
  void add_steps(std::int64_t steps) {
    paused = true;
    single_steps += steps;
    ++pause_requests;
  }
  void set_speed(double times) {
    speed = times;
    ++changes;
  }
  void clear_until() {
    until.reset();
    until_event.clear();
  }
};

}  // namespace sim
