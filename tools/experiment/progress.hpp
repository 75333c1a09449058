#pragma once

#include <chrono>
#include <string>

#include "sim/time.hpp"

namespace tools {

/// Tells people how far a run is: one live line on a terminal, a line every 10 s in a pipe.
class Progress {
 public:
  /// `duration_s` 0: open end.
  Progress(double duration_s, bool quiet);
  /// Cheap enough to call at every step.
  void update(sim::Time now, std::uint64_t messages, bool paused);
  /// Clears the live line, so that other output starts on a fresh one.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  double duration_s_;
  bool quiet_;
  bool terminal_;
  bool shown_ = false;
  int skip_ = 0;
  Clock::time_point last_;
  sim::Time last_now_{0};
  std::uint64_t last_messages_ = 0;
};

}  // namespace tools
