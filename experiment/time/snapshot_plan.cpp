// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/time/snapshot_plan.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <utility>

#include "experiment/results/run_error.hpp"

namespace experiment {

SnapshotPlan::SnapshotPlan(const std::vector<double>& at_s, std::optional<double> every_s, const Span& span)
    : step_(span.step), first_step_(span.first_step) {
  const double step_s = sim::to_seconds(step_);
  if (every_s) per_step_ = step_s / *every_s;
  for (const double time_s : at_s) {
    const std::int64_t step = std::llround(time_s / step_s);
    if (span.duration_s > 0 && step > std::llround(span.duration_s / step_s))
      throw RunError(
          2, "configuration",
          fmt::format("--snapshot-at: {:.6g} s is after the end of the run at {:.6g} s", time_s, span.duration_s));
    if (step < first_step_)
      throw RunError(2, "configuration",
                     fmt::format("--snapshot-at: {:.6g} s is before the start of the run at {:.6g} s", time_s,
                                 sim::to_seconds(step_ * first_step_)));
    at_.insert(step);
  }
}

std::set<std::int64_t> SnapshotPlan::next_steps() const {
  std::set<std::int64_t> steps = at_;
  if (per_step_) {
    const double next = std::floor((2 * static_cast<double>(first_step_) + 1) * *per_step_ / 2) + 1;
    steps.insert(static_cast<std::int64_t>(std::ceil(next / *per_step_ - 0.5)));
  }
  return steps;
}

bool SnapshotPlan::take(std::int64_t step) {
  const bool is_given = at_.erase(step) > 0;
  if (!std::exchange(has_begun_, true) || !per_step_) return is_given;
  const auto half_steps = static_cast<double>(2 * step);  // whole numbers: a time halfway between steps counts once
  return is_given || std::floor((half_steps + 1) * *per_step_ / 2) > std::floor((half_steps - 1) * *per_step_ / 2);
}

std::vector<double> SnapshotPlan::missing_s() const {
  std::vector<double> times_s;
  for (const std::int64_t step : at_) times_s.push_back(sim::to_seconds(step_ * step));
  return times_s;
}

}  // namespace experiment
