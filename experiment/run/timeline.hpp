// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace experiment {

/// Interface to rewind and restore a run.
class Timeline {
 public:
  virtual ~Timeline() = default;
  /// Prepares a move; the branch is still the old one.  `ours`: the new one starts at a step of this run.  The world is
  /// not moved when this throws.
  virtual void leave_branch(std::int64_t to_step, bool ours) = 0;
  /// Replaces start_branch() when the move failed and the world was restored.
  virtual void hold_here() = 0;
  /// Completes a move.
  virtual void start_branch(bool ours) = 0;
};

}  // namespace experiment
