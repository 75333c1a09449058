// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/set_points.hpp"

#include <algorithm>

namespace motion {

void SetPoints::move(std::size_t joint, double velocity, const std::optional<Goal>& goal) {
  const Limits& limits = limits_[joint];
  const double before = values_[joint];
  double after = before + std::clamp(velocity, -limits.velocity, limits.velocity) * frame_s_;
  // A joint that starts beyond its range does not jump into it.
  const double within = std::clamp(after, std::min(limits.low, before), std::max(limits.high, before));
  at_limit_[joint] = within != after;
  after = within;
  reach_[joint] = {before, before - limits.velocity * frame_s_, before + limits.velocity * frame_s_};
  if (goal) {
    const double reach = limits.velocity * std::max(0.0, goal->in_s);
    after = std::clamp(after, goal->value - reach, goal->value + reach);
    reach_[joint]->low = std::max(reach_[joint]->low, goal->value - reach);
    reach_[joint]->high = std::min(reach_[joint]->high, goal->value + reach);
  }
  values_[joint] = after;
}

bool SetPoints::is_too_fast(std::size_t joint) const {
  constexpr double rounding = 1e-9;
  const std::optional<Reach>& reach = reach_[joint];
  return reach && (limited_[joint] < reach->low - rounding || limited_[joint] > reach->high + rounding);
}

/// Sends a joint that would jump towards its range, as fast as it can, and holds those on which the range depends.
/// Returns whether this changes anything.
bool SetPoints::let_wait(std::span<const std::size_t> joints, std::size_t joint) {
  bool changes = false;
  const auto set = [&](std::size_t which, double value) {
    changes = changes || desired_[which] != value;
    desired_[which] = value;
  };
  if (!waits_[joint]) set(joint, std::max(reach_[joint]->low, std::min(limited_[joint], reach_[joint]->high)));
  for (const std::size_t other : joints) {
    if (!reach_[other] || waits_[other] || !pairs_.depends_on(joint, other)) continue;
    waits_[other] = true;
    set(other, std::max(reach_[other]->low, std::min(reach_[other]->before, reach_[other]->high)));
  }
  return changes;
}

/// Finds the limited values, by letting joints wait.  Returns whether none is too fast.
bool SetPoints::find_limited(std::span<const std::size_t> joints) {
  desired_ = values_;
  waits_.assign(values_.size(), false);
  for (bool changes = true; changes;) {
    limited_ = desired_;
    pairs_.limit(limited_);
    changes = false;
    bool is_found = true;
    for (const std::size_t joint : joints) {
      if (!is_too_fast(joint)) continue;
      is_found = false;
      changes = let_wait(joints, joint) || changes;
    }
    if (is_found) return true;
  }
  return false;
}

void SetPoints::limit(std::span<const std::size_t> joints) {
  limited_ = values_;
  if (pairs_.limit(limited_) == 0) return;
  // Pairs of joints limit each other: only armed joints may give way, if that is enough.
  if (!find_limited(joints)) {
    limited_ = values_;
    pairs_.limit(limited_);
  }
  for (const std::size_t joint : joints) {
    at_limit_[joint] = at_limit_[joint] || limited_[joint] != values_[joint];
    values_[joint] = limited_[joint];
  }
}

}  // namespace motion
