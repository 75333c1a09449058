// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <iostream>
#include <string>
#include <utility>

namespace bridges {

/// Says once on standard error what a program waits for, when that takes long.
class WaitNotice {
 public:
  using Clock = std::chrono::steady_clock;
  /// A person who looks at a still terminal wonders by then.
  static constexpr std::chrono::milliseconds usual_patience{3000};

  /// `text`: one sentence of who waits for what, on which channel and LCM URL.  Zero: nothing is said.
  WaitNotice(std::string text, std::chrono::milliseconds after = usual_patience)
      : text_(std::move(text)), said_(after.count() <= 0), due_(Clock::now() + after) {}

  /// To be called now and then while waiting.
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
