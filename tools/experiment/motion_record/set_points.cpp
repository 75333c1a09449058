// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/motion_record/set_points.hpp"

#include <algorithm>

namespace tools {

void SetPoints::move(std::size_t joint, double velocity, const std::optional<Goal>& goal) {
  const Limits& limits = limits_[joint];
  const double before = values_[joint];
  double after = before + std::clamp(velocity, -limits.velocity, limits.velocity) * frame_s_;
  // A joint that starts beyond its range does not jump into it.
  const double within = std::clamp(after, std::min(limits.low, before), std::max(limits.high, before));
  at_limit_[joint] = within != after;
  after = within;
  if (goal) {
    const double reach = limits.velocity * std::max(0.0, goal->in_s);
    after = std::clamp(after, goal->value - reach, goal->value + reach);
  }
  values_[joint] = after;
}

void SetPoints::limit(std::span<const std::size_t> joints) {
  limited_ = values_;
  if (pairs_.limit(limited_) == 0) return;
  for (const std::size_t joint : joints) {
    at_limit_[joint] = at_limit_[joint] || limited_[joint] != values_[joint];
    values_[joint] = limited_[joint];
  }
}

}  // namespace tools
