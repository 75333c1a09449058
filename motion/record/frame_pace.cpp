// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/frame_pace.hpp"

#include <spdlog/fmt/fmt.h>

namespace motion {

void FramePace::begin(Clock::time_point now) {
  constexpr std::chrono::milliseconds max_to_catch_up{100};
  const Clock::duration delay = now - due();
  last_ = delay > max_to_catch_up ? now : due();
  ++frames_;
  if (delay <= tolerance_) return;
  ++late_;
  latest_ = std::max(latest_, delay);
}

std::string FramePace::text() const {
  const auto ms = [](Clock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); };
  std::string text =
      fmt::format("{} of {} frames began more than a step, {:.3g} ms, late", late_, frames_, ms(tolerance_));
  if (late_ > 0) text += fmt::format(", by {:.1f} ms at most", ms(latest_));
  return text;
}

}  // namespace motion
