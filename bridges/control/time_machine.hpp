// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace bridges {

/// Carries out requests about the time of the world: how fast it goes on, and where it goes back to.
class TimeMachine {
 public:
  virtual ~TimeMachine() = default;
  /// What came of a request; nothing when the command is none of its own.  Throws std::runtime_error that says why it
  /// was refused.
  virtual std::optional<std::string> obey(const std::string& command, const std::string& text, double value) = 0;
};

}  // namespace bridges
