// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <iostream>
#include <string>
#include <utility>

namespace bridges {

/// Warns once on standard error what a program waits for, when that takes long.
class WaitWarning {
 public:
  using Clock = std::chrono::steady_clock;
  /// A delay after which a user expects output.
  static constexpr std::chrono::milliseconds default_delay{3000};

  /// `text`: one sentence of who waits for what, on which channel and LCM URL.  Zero: no warning.
  WaitWarning(std::string text, std::chrono::milliseconds after = default_delay)
      : text_(std::move(text)), said_(after.count() <= 0), due_(Clock::now() + after) {}

  /// To be called from time to time while waiting.
  void look() {
    if (said_ || Clock::now() < due_) return;
    said_ = true;
    std::cerr << text_ << std::endl;
  }

 private:
  std::string text_;
  bool said_;
  Clock::time_point due_;
};

}  // namespace bridges
