// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "sim/base/time.hpp"

namespace experiment {

/// Steps at which a run writes snapshot files: at given times (--snapshot-at) and in an interval (--snapshot-every).
class SnapshotPlan {
 public:
  /// Span of a run.
  struct Span {
    sim::Time step{0};            ///< length of a step
    std::int64_t first_step = 0;  ///< step at which the run starts
    double duration_s = 0;        ///< time of its end; 0: unknown
  };
  /// Throws RunError for a time that the run does not reach.
  SnapshotPlan(const std::vector<double>& at_s, std::optional<double> every_s, const Span& span);

  /// Returns the steps that are known to come: those of the given times, and the next one of the interval.
  std::set<std::int64_t> next_steps() const;
  /// Returns whether a snapshot of this step is due; to be asked before the first step, and after each.
  bool take(std::int64_t step);
  /// Returns the given times at which no snapshot was due yet, s.
  std::vector<double> missing_s() const;

 private:
  sim::Time step_;
  std::int64_t first_step_;
  std::set<std::int64_t> at_;       ///< still to come
  std::optional<double> per_step_;  ///< intervals in a step
  bool has_begun_ = false;          ///< the state at the start belongs to the run before
};

}  // namespace experiment
