// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "sim/base/time.hpp"

namespace sim {

/// Parts of a step whose time is measured, in their order; `medium` has two places.  Two of them are one stage of
/// docs/develop/architecture.md each: `rays`, `sensors` (sense and report).
enum class StepStage { messages, medium, act, hydrodynamics, script, physics, events, rays, sensors, hash };
inline constexpr std::array<const char*, 10> step_stage_names = {
    "messages", "medium", "act", "hydrodynamics", "script", "physics", "events", "rays", "sensors", "hash"};

/// Times of the stages since the start of the measurement, in CPU time of the thread that steps: close to the wall
/// time, even where it works with others, but without what other programs take.
struct StageTimes {
  StageTimes();

  std::array<double, step_stage_names.size()> cpu_s{};
  std::int64_t steps = 0;
  std::int64_t rays = 0;  ///< cast by sensors
  double clock_s = 0;     ///< what reading the clock takes, which is subtracted
};

/// Adds the time since the last call to a stage.  Without StageTimes it does nothing, and reads no clock.
class StageClock {
 public:
  explicit StageClock(StageTimes* times) : times_(times) {
    if (times_ == nullptr) return;
    ++times_->steps;
    last_s_ = now_s();
  }
  void end(StepStage stage) {
    if (times_ != nullptr) add(stage);
  }
  void count_rays(std::int64_t rays) {
    if (times_ != nullptr) times_->rays += rays;
  }
  /// Returns the CPU time of this thread.
  static double now_s() { return thread_cpu_s(); }

 private:
  void add(StepStage stage);

  StageTimes* times_;
  double last_s_ = 0;
};

}  // namespace sim
