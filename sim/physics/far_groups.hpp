// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "sim/collision/collider.hpp"
#include "sim/collision/group_boxes.hpp"
#include "sim/physics/groups.hpp"

namespace sim {

/// Takes groups that are far from everything out of the collision space, and brings them back before they can touch
/// anything.  This class owns
/// - a box for each group, wide enough for `horizon_s_` at its speed; GroupBoxes tells which boxes meet nothing,
/// - the list of groups that left their boxes or are new: bodies have the leeway in their boxes, so that a thread that
///   moves a body sees at once whether it left,
/// - what it saw of fixed parts and of bodies that were placed elsewhere, when it looked last.
///
/// Order within a step: update() comes first, before Collider searches for pairs.  It makes all boxes again about once
/// a second, or when fixed parts changed, and in other steps only those of the groups in the list.  Later in the step
/// threads call note_left() with the bodies that left their boxes.  The next update() is early enough, since contacts
/// are only found where parts overlap when a step begins.  On a common ground nothing is far, and for some hundred
/// steps it is not tried again.
///
/// Which groups are far is not state: it is neither hashed nor saved, and no bit of a motion depends on it, for what is
/// far has no pairs in the collision space either.
class FarGroups {
 public:
  /// `moves`: of the world.
  FarGroups(Groups& groups, Collider& collider, const SceneMoves& moves)
      : groups_(groups), collider_(collider), moves_(moves) {}

  /// Brings groups that may touch something in this step into the collision space.
  void update();
  /// Notes that a group was added, or is about to be removed.
  void note(int group);
  /// Forgets the box of a group that is about to be removed.
  void remove(int group) { boxes_.remove(group); }
  /// Notes the groups of bodies that left their boxes.  Thread-safe.
  void note_left(const std::vector<int>& groups);

  /// Whether a group is out of the collision space.
  bool far(int group) const { return boxes_.far(group); }
  /// Number of times that groups came near, or all boxes were made: until it changes, far() tells the same.
  std::uint64_t changes() const { return changes_; }

 private:
  std::optional<AlignedBox> make_box(const Group& group) const;
  void make_boxes();
  void find_all();
  void move(int group);

  Groups& groups_;
  Collider& collider_;
  const SceneMoves& moves_;
  GroupBoxes boxes_;
  std::vector<int> left_;  // new groups, and those of bodies that left their boxes; several times the same
  std::mutex left_mutex_;
  bool fixed_parts_changed_ = true;            ///< some were added or removed
  std::uint64_t fixed_moves_ = 0, jumps_ = 0;  // of moves_, at the last update
  double horizon_s_ = 1;                       ///< for which a box suffices at constant speed
  int steps_without_ = 0;                      ///< until it is tried again
  std::uint64_t changes_ = 0;
};

}  // namespace sim
