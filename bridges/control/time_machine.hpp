// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace bridges {

/// Interface that executes requests about simulated time: speed, pause, rewind and restore.
class TimeMachine {
 public:
  virtual ~TimeMachine() = default;
  /// Returns the result of a request; none when the command is unknown.  Throws std::runtime_error with the reason when
  /// it is refused.
  virtual std::optional<std::string> execute(const std::string& command, const std::string& text, double value) = 0;
};

}  // namespace bridges
