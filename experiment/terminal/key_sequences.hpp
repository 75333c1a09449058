// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

#include "experiment/terminal/terminal_parser.hpp"

namespace experiment {

/// Separates keys of one byte from keys that a terminal sends as several, such as arrows, Home and F1.  These are
/// discarded.
class KeySequences {
 public:
  using Clock = std::chrono::steady_clock;
  /// A single key is distinguished from the start of a sequence by a pause of this length.
  static constexpr std::chrono::milliseconds timeout{50};

  /// Returns the keys that the bytes of a terminal, passed one by one, represent.  None: this byte belongs to a
  /// sequence, or may belong to one.
  std::string next(char byte, Clock::time_point now);
  /// Returns ESC once it is certain that it was pressed alone.
  std::string alone(Clock::time_point now);

 private:
  TerminalParser parser_;
  Clock::time_point begun_{};
};

}  // namespace experiment
