// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/base/time.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// The step whose events the acoustic channel handles.  Bodies do not move meanwhile, so that transducers compute their
/// motion once for all events of a step: hundreds of signals may arrive in one.
class MotionClock {
 public:
  /// Begins to handle events; `now`: end of the step that just ended.
  void begin(Time now) {
    if (now != step_end_) ++serial_;
    step_end_ = now;
    handling_ = true;
  }
  void end() { handling_ = false; }
  Time step_end() const { return step_end_; }
  /// Serial number of the present motion of all bodies while events are handled; else negative: bodies may have moved.
  std::int64_t serial() const { return handling_ ? serial_ : -1; }
  void visit_state(StateArchive& archive) {
    archive.unhashed(step_end_);
    if (archive.restoring()) ++serial_;
  }

 private:
  Time step_end_{0};
  std::int64_t serial_ = 0;
  bool handling_ = false;
};

}  // namespace sim
