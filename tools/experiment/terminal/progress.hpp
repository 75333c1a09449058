// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

#include "sim/base/time.hpp"
#include "sim/run/run_control.hpp"

namespace tools {

/// Tells people how far a run is: one live line on a terminal, a line every 10 s in a pipe.
class Progress {
 public:
  /// `duration_s` 0: open end.
  Progress(double duration_s, bool quiet);
  /// Cheap enough to call at every step.  `waits`: the world stands.
  void update(sim::Time now, std::uint64_t messages, const sim::RunControl& control, bool waits);
  /// Clears the live line, so that other output starts on a fresh one.
  void clear();
  /// Words for people, on lines of their own.
  void report(const std::string& text);
  /// A question takes the place of the live line until something is said.
  void send_request(const std::string& text);
  /// Time went back.
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

}  // namespace tools
