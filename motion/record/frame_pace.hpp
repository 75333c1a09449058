// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>

namespace motion {

/// Times at which the frames of a recording begin by the clock, and how late they did.
class FramePace {
 public:
  using Clock = std::chrono::steady_clock;

  /// `period`: of the clock between two frames.  `tolerance`: a frame that begins later than this is late.
  FramePace(Clock::duration period, Clock::duration tolerance) : period_(period), tolerance_(tolerance) {}

  /// Returns when the next frame is due.
  Clock::time_point due() const { return last_ + period_; }
  /// Takes the beginning of the next frame.  After a long delay the following ones are due by it: the recording is then
  /// slower than the clock.
  void begin(Clock::time_point now);
  /// Starts again: the next frame is due a period after this.
  void restart(Clock::time_point now) { last_ = now; }

  std::int64_t frames() const { return frames_; }
  std::int64_t late() const { return late_; }
  /// Returns the numbers as a line, without its end.
  std::string text() const;

 private:
  Clock::duration period_, tolerance_, latest_{};
  Clock::time_point last_{};
  std::int64_t frames_ = 0, late_ = 0;
};

}  // namespace motion
