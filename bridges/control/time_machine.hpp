// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace bridges {

/// Executes requests about simulated time: speed, pause, rewind and restore.
class TimeMachine {
 public:
  virtual ~TimeMachine() = default;
  /// The result of a request; nothing when it does not know the command.  Throws std::runtime_error that says why it
  /// was refused.
  virtual std::optional<std::string> execute(const std::string& command, const std::string& text, double value) = 0;
};

}  // namespace bridges
