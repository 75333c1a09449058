// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/report_clock.hpp"

#include <algorithm>
#include <cmath>

#include "autonomy/filters/pose2.hpp"

namespace autonomy {

ReportClock::Jump ReportClock::note(std::int64_t utime) {
  Jump jump;
  const Elapsed elapsed = elapsed_s();
  steps_ = 0;
  if (time_ != 0) {
    const double later_s = seconds(utime - time_);
    const double set_s = later_s - std::clamp(later_s, elapsed.least, elapsed.most);
    if (set_s < -late_s || set_s > max_gap_s) jump.set_us = std::llround(1e6 * set_s);
    time_ += jump.set_us;
    if (seconds(utime - time_) > max_gap_s) jump.silent_s = seconds(utime - time_);
  }
  time_ = std::max(time_, utime);
  return jump;
}

}  // namespace autonomy
