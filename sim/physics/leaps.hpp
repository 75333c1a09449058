// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <utility>
#include <vector>

#include "sim/physics/far_groups.hpp"
#include "sim/physics/groups.hpp"

namespace sim {

/// Finds bodies that move further than their size in a step: contacts are only found where parts overlap at its end, so
/// that such a body may pass through a wall.  This class owns
/// - the bodies that a step found to be fast, and
/// - the leaps that were not taken yet.
///
/// Each free body with parts has a speed from which on it is looked at.  At first that is the speed at which it moves
/// by the shortest side of its box in a step; when it was looked at and is longer along its motion, a speed a little
/// above its present one; after a leap none, so that a body is reported once.
///
/// Order within a step: threads call note_fast() after they moved bodies, find() comes at the end, when all are where
/// they will be.  Groups that are far from everything are left out.  The list is sorted, so that threads do not matter.
/// Nothing here is hashed or saved; a world that was restored looks at each body again.
class Leaps {
 public:
  Leaps(double step_s, const Groups& groups, const FarGroups& far_groups)
      : step_s_(step_s), groups_(groups), far_groups_(far_groups) {}

  /// Sets the speeds of a new group from which on its bodies are looked at.
  void plan(const Group& group) const;
  /// Forgets which bodies have moved too far: a restored world may come to it again.
  void plan_anew();
  /// Notes bodies above their speeds.  Thread-safe.
  void note_fast(const std::vector<int>& bodies);
  void find();
  /// Returns those found since the last call.
  std::vector<Leap> take() { return std::exchange(leaps_, {}); }

 private:
  void look_at(SteppedBody& body);

  double step_s_;
  const Groups& groups_;
  const FarGroups& far_groups_;
  std::vector<int> fast_;  // bodies, in the order of the threads
  std::mutex fast_mutex_;
  std::vector<Leap> leaps_;
};

}  // namespace sim
