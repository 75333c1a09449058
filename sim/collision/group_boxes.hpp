// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "sim/geometry/box_grid.hpp"

namespace sim {

/// Boxes of groups.  A group is far from everything when its box meets no box of another group and no fixed part.
class GroupBoxes {
 public:
  /// Removes all boxes; then the groups have the numbers below `groups`.
  void clear(std::size_t groups);
  /// Sets the box of a group; it has no effect before find().
  void set(int group, const AlignedBox& box);
  /// Finds which groups with a box are far.  `fixed`: boxes of fixed parts, which may be infinite.
  void find(std::span<const AlignedBox> fixed);
  /// Sets the box of a group after find(), and calls near(number) for it and for the groups that it meets, if it is not
  /// far from everything; they stay near until the next find().
  template <typename Near>
  void move(int group, const AlignedBox& box, const Near& near) {
    const int place = place_of(group);
    boxes_[static_cast<std::size_t>(place)] = box;
    bool meets = meets_fixed(box);
    for (int other = 0; other < static_cast<int>(boxes_.size()); ++other) {
      if (other == place || !boxes_[static_cast<std::size_t>(other)].meets(box)) continue;
      meets = true;
      become_near(other, near);
    }
    if (meets) become_near(place, near);
  }
  /// Removes the box of a group.
  void remove(int group);
  /// Whether a group is far; false without a box.
  bool far(int group) const {
    const auto number = static_cast<std::size_t>(group);
    return number < places_.size() && places_[number] >= 0 && far_[static_cast<std::size_t>(places_[number])];
  }
  std::size_t boxes() const { return boxes_.size(); }
  /// Number of groups that are far.
  std::size_t count() const { return count_; }

 private:
  int place_of(int group);
  bool meets_fixed(const AlignedBox& box) const;
  template <typename Near>
  void become_near(int place, const Near& near) {
    if (!far_[static_cast<std::size_t>(place)]) return;
    far_[static_cast<std::size_t>(place)] = false;
    --count_;
    near(groups_[static_cast<std::size_t>(place)]);
  }

  std::vector<int> places_;  // by group: its place in the lists below; -1: none
  std::vector<int> groups_;
  std::vector<AlignedBox> boxes_;
  std::vector<char> far_;
  std::vector<AlignedBox> endless_;  // of fixed parts
  BoxGrid fixed_, moving_;
  std::size_t count_ = 0;
};

}  // namespace sim
