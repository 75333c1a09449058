// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>

namespace sim {

/// Simulated time since the start of the run in whole microseconds; never wall time.
using Time = std::chrono::microseconds;

inline double to_seconds(Time t) {
  return static_cast<double>(t.count()) * 1e-6;
}
/// Rounds to the nearest microsecond.
inline Time from_seconds(double t_s) {
  return Time{std::llround(t_s * 1e6)};
}

/// Returns the CPU time of this thread, s.
inline double thread_cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace sim
