// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "sim/world_file/metric_registry.hpp"

namespace experiment {

/// Parameters of a metric that scores from `from_s` until `until_s`.
struct ScoredPeriod : sim::MetricParams {
  double until_s = std::numeric_limits<double>::infinity();

  /// ` until 3700 s`, or an empty text.
  std::string to_until_s() const { return std::isfinite(until_s) ? fmt::format(" until {:.6g} s", until_s) : ""; }

 protected:
  void read_period(sim::ParamReader& in) {
    read_from_s(in);
    std::optional<double> until;
    in.read("until_s", until, sim::at_least(0), "end of the scoring, simulated time; unset: the end of the run");
    if (!until) return;
    until_s = *until;
    if (until_s <= from_s) in.error("until_s", "'until_s' must be later than 'from_s'");
  }
};

}  // namespace experiment
