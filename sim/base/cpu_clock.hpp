// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

namespace sim {

/// Returns the CPU time of this thread, s.
inline double thread_cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace sim
