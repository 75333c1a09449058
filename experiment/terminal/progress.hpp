// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

#include "sim/base/time.hpp"
#include "sim/run/run_control.hpp"

namespace experiment {

/// Shows the progress of a run: one live line on a terminal, a line every 10 s in a pipe.
class Progress {
 public:
  /// `duration_s` 0: no end.
  Progress(double duration_s, bool quiet);
  /// Updates the display; cheap enough to call at every step.  `waits`: the world is paused.
  void update(sim::Time now, std::uint64_t messages, const sim::RunControl& control, bool waits);
  /// Clears the live line, so that other output starts on a new one.
  void clear();
  /// Prints text on separate lines.
  void report(const std::string& text);
  /// Shows a question in place of the live line until the next line is printed.
  void send_request(const std::string& text);
  /// Call after a rewind.
  void restart(sim::Time now);

 private:
  using Clock = std::chrono::steady_clock;
  void show(const std::string& line);

  double duration_s_;
  bool quiet_;
  bool terminal_;
  bool shown_ = false, asking_ = false;
  std::size_t width_ = 0;  ///< of the live line
  int skip_ = 0;
  Clock::time_point last_;
  sim::Time last_now_{0};
  std::uint64_t last_messages_ = 0;
};

}  // namespace experiment
