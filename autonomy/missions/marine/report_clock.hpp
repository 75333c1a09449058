// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace autonomy {

/// Time of a vehicle by the stamps of its reports, which arrive in order except for their latencies, many per second.
/// A stamp that is older than the newest by more than `late_s`, or newer by more than `max_gap_s`, means that the clock
/// was set.  Time that also passed for step() was silence of all devices, as after a power failure, and does not count
/// as such a jump.
class ReportClock {
 public:
  static constexpr double late_s = 2;
  static constexpr double max_gap_s = 5;
  /// Silence of all devices together, which is longer than their intervals.
  static constexpr double max_quiet_s = 1;

  /// What a stamp says of the time before it.
  struct Jump {
    std::int64_t set_us = 0;  ///< by which the clock was set; 0: it was not
    double silent_s = 0;      ///< silence of more than max_gap_s; else 0
  };

  /// `period_s`: between two calls of step().
  explicit ReportClock(double period_s) : period_s_(period_s) {}

  /// Processes the stamp of a report.
  Jump note(std::int64_t utime);
  /// Counts a decision of the program.
  void step() { ++steps_; }

  /// Newest stamp; 0: there was none.
  std::int64_t time() const { return time_; }
  bool is_silent() const { return elapsed_s().least > max_quiet_s; }

 private:
  struct Elapsed {
    double least = 0, most = 0;
  };
  /// Time since the last report: of the counted steps, the first ends the period that contains that report.
  Elapsed elapsed_s() const { return {steps_ > 1 ? (steps_ - 1) * period_s_ : 0, steps_ * period_s_}; }

  double period_s_;
  std::int64_t time_ = 0;
  int steps_ = 0;  ///< since the last report
};

}  // namespace autonomy
