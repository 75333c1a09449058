// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tools {

/// What a run does when its world goes elsewhere in time.
class Timeline {
 public:
  virtual ~Timeline() = default;
  /// Before: the branch is as it was left.  `ours`: the new one begins at a step that this run has been at.  The world
  /// stays where it is when this throws.
  virtual void leave_branch(std::int64_t to_step, bool ours) = 0;
  /// Instead of start_branch(): the world is where it was after all.
  virtual void hold_here() = 0;
  /// After.
  virtual void start_branch(bool ours) = 0;
};

}  // namespace tools
