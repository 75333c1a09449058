// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/base/time.hpp"
#include "sim/run/run_control.hpp"

namespace experiment {

/// Executes a request to pause, resume, step or set the speed; returns whether it was one.  Throws std::runtime_error
/// for a number of steps or a speed that is not possible.
inline bool set_pace(sim::RunControl& control, const std::string& command, double value) {
  if (command == "pause" || command == "resume") {
    control.set_paused(command == "pause");
  } else if (command == "step") {
    if (!(value >= 1 && value <= 1e9 && value == std::floor(value)))
      throw std::runtime_error(fmt::format("'step' needs a whole number of steps from 1 to 1e9, got {}", value));
    control.add_steps(static_cast<std::int64_t>(value));
  } else if (command == "speed") {
    if (value != 0 && !(value >= 1e-3 && value <= 1e6))
      throw std::runtime_error(
          fmt::format("'speed' must be 0 (as fast as possible) or from 0.001 to 1e6, got {}", value));
    control.set_speed(value);
  } else {
    return false;
  }
  return true;
}

/// Limits simulated time to a multiple of wall time.
class Pacer {
 public:
  /// Returns the time to wait before the step that ends at `next`.
  std::chrono::microseconds until(sim::Time next, const sim::RunControl& control) {
    if (control.speed <= 0) return std::chrono::microseconds{0};
    const auto now = Clock::now();
    if (!started_ || changes_ != control.changes) start(next, now, control);
    const auto ahead = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(sim::to_seconds(next - sim_start_) / control.speed));
    const auto wait = std::chrono::duration_cast<std::chrono::microseconds>(wall_start_ + ahead - now);
    // On a machine that is too slow, continue from the present time instead of catching up.
    if (wait < std::chrono::milliseconds(-500)) start(next, now, control);
    return std::max(wait, std::chrono::microseconds{0});
  }

 private:
  using Clock = std::chrono::steady_clock;

  void start(sim::Time next, Clock::time_point now, const sim::RunControl& control) {
    started_ = true;
    changes_ = control.changes;
    sim_start_ = next;
    wall_start_ = now;
  }

  bool started_ = false;
  std::int64_t changes_ = 0;
  sim::Time sim_start_{0};
  Clock::time_point wall_start_;
};

}  // namespace experiment
