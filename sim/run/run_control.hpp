#pragma once

#include <cstdint>

namespace sim {

/// What people and programs ask of a run while it goes.
struct RunControl {
  bool paused = false;
  bool quit = false;
  double speed = 0;               ///< times real time; 0: as fast as possible
  std::int64_t single_steps = 0;  ///< to take although paused
  std::int64_t changes = 0;       ///< counts changes of paused and speed, so that pacing starts anew

  bool may_step() const { return !quit && (!paused || single_steps > 0); }
  void step_taken() {
    if (paused && single_steps > 0) --single_steps;
  }
};

}  // namespace sim
