// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <iostream>
#include <string>
#include <utility>

namespace bridges {

/// Warning on standard error, given once, when a program waits long for a message.
class WaitWarning {
 public:
  using Clock = std::chrono::steady_clock;
  /// Delay after which a user expects output.
  static constexpr std::chrono::milliseconds default_delay{3000};

  /// `text`: one sentence with the waiting program, the expected message, its channel and LCM URL.  `after` zero: no
  /// warning.
  WaitWarning(std::string text, std::chrono::milliseconds after = default_delay)
      : text_(std::move(text)), warned_(after.count() <= 0), due_(Clock::now() + after) {}

  /// Prints the warning when it is due; must be called periodically while waiting.
  void look() {
    if (warned_ || Clock::now() < due_) return;
    warned_ = true;
    std::cerr << text_ << std::endl;
  }

 private:
  std::string text_;
  bool warned_;
  Clock::time_point due_;
};

}  // namespace bridges
