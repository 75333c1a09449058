// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/group_boxes.hpp"

#include <algorithm>
#include <limits>

namespace sim {

void GroupBoxes::clear(std::size_t groups) {
  places_.assign(groups, -1);
  groups_.clear();
  boxes_.clear();
  far_.clear();
  count_ = 0;
}

void GroupBoxes::set(int group, const AlignedBox& box) {
  places_[static_cast<std::size_t>(group)] = static_cast<int>(boxes_.size());
  groups_.push_back(group);
  boxes_.push_back(box);
}

/// Returns the place of a group, which is far until its box meets another one if it had none.
int GroupBoxes::place_of(int group) {
  const auto number = static_cast<std::size_t>(group);
  if (number >= places_.size()) places_.resize(number + 1, -1);
  if (places_[number] >= 0) return places_[number];
  places_[number] = static_cast<int>(boxes_.size());
  groups_.push_back(group);
  boxes_.emplace_back();
  far_.push_back(true);
  ++count_;
  return places_[number];
}

void GroupBoxes::remove(int group) {
  const auto number = static_cast<std::size_t>(group);
  if (number >= places_.size() || places_[number] < 0) return;
  const auto place = static_cast<std::size_t>(places_[number]);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  boxes_[place] = {Vector3d::Constant(infinity), Vector3d::Constant(-infinity)};  // meets nothing
  if (far_[place]) --count_;
  far_[place] = false;
  places_[number] = -1;
}

void GroupBoxes::find(std::span<const AlignedBox> fixed) {
  // Fixed parts.
  endless_.clear();
  std::vector<AlignedBox> finite;
  for (const AlignedBox& box : fixed) (box.low.allFinite() && box.high.allFinite() ? finite : endless_).push_back(box);
  fixed_.build(finite);
  // Groups.
  moving_.build(boxes_);
  far_.assign(boxes_.size(), false);
  count_ = 0;
  for (std::size_t place = 0; place < boxes_.size(); ++place) {
    bool meets = meets_fixed(boxes_[place]);
    if (!meets) moving_.find(boxes_[place], [&](int other) { meets |= other != static_cast<int>(place); });
    far_[place] = !meets;
    count_ += meets ? 0 : 1;
  }
}

bool GroupBoxes::meets_fixed(const AlignedBox& box) const {
  const auto meets_box = [&](const AlignedBox& other) { return other.meets(box); };
  bool meets = std::any_of(endless_.begin(), endless_.end(), meets_box);
  if (!meets) fixed_.find(box, [&](int) { meets = true; });
  return meets;
}

}  // namespace sim
