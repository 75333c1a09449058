// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/run/run_control.hpp"

namespace bridges {

/// Pause that the lockstep itself starts while the world waits for a client, and ends with the wait.  A user who pauses
/// or resumes the world meanwhile takes it over.
class OwnPause {
 public:
  /// `control` must outlive this.
  explicit OwnPause(sim::RunControl& control) : control_(control) {}

  bool holds() const { return holds_; }
  /// Pauses the world, unless a user has done so.
  void start() {
    if (control_.paused) return;
    holds_ = control_.paused = true;
    requests_ = control_.pause_requests;
    ++control_.changes;
  }
  /// Ends the pause.  Returns whether the world continues; it does not when a user has paused it since.
  bool end() {
    if (!holds_) return false;
    holds_ = false;
    if (control_.pause_requests != requests_) return false;
    control_.paused = false;
    ++control_.changes;
    return true;
  }
  /// Leaves it to the user whether the world is paused.
  void forget() { holds_ = false; }

 private:
  sim::RunControl& control_;
  bool holds_ = false;
  std::int64_t requests_ = 0;  // RunControl::pause_requests at the start
};

}  // namespace bridges
