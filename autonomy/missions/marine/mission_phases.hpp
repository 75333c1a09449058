// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "autonomy/filters/pose2.hpp"

namespace autonomy {

/// Phases of the mission of a marine vehicle: it waits for its first fix, stays at the surface for some time, is under
/// way with its behavior, and is done with it.
class MissionPhases {
 public:
  enum class Phase { waiting_for_fix, at_surface, under_way, done };

  /// `surface_s`: at the surface after the first fix; 0 for a start that is known.
  explicit MissionPhases(double surface_s) : surface_s_(surface_s) {}

  /// The position is known from this time on.
  void begin(std::int64_t utime) {
    began_utime_ = utime;
    phase_ = Phase::at_surface;
  }
  /// Returns the phase at a time; `finished`: the behavior is.
  Phase update(std::int64_t utime, bool finished) {
    if (phase_ == Phase::at_surface && seconds(utime - began_utime_) >= surface_s_) phase_ = Phase::under_way;
    if (phase_ == Phase::under_way && finished) phase_ = Phase::done;
    return phase_;
  }
  /// There is another behavior.
  void resume() {
    if (phase_ == Phase::done) phase_ = Phase::under_way;
  }
  /// The clock was set.
  void shift(std::int64_t by_us) { began_utime_ += by_us; }
  Phase phase() const { return phase_; }

 private:
  double surface_s_;
  std::int64_t began_utime_ = 0;
  Phase phase_ = Phase::waiting_for_fix;
};

}  // namespace autonomy
