// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>

#include "sim/base/time.hpp"
#include "sim/run/run_control.hpp"

namespace tools {

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

}  // namespace tools
