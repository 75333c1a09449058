// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/stage_times.hpp"

#include <algorithm>

namespace sim {

StageTimes::StageTimes() {
  constexpr int reads = 200;
  const double start_s = StageClock::now_s();
  double end_s = start_s;
  for (int i = 0; i < reads; ++i) end_s = StageClock::now_s();
  clock_s = (end_s - start_s) / reads;
}

void StageClock::add(StepStage stage) {
  const double now = now_s();
  times_->cpu_s[static_cast<std::size_t>(stage)] += std::max(0.0, now - last_s_ - times_->clock_s);
  last_s_ = now;
}

}  // namespace sim
