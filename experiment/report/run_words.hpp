// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "experiment/results/run_metrics.hpp"
#include "experiment/results/run_record.hpp"

namespace experiment {

/// Describes the outcome of rules in one line: `7 of 8 rules hold, 1 failed.`  Empty when there are none.
std::string rules_in_words(const std::vector<RunRecord::Rule>& rules);

/// Describes the results of the metrics, one sentence each:
/// `auv localizes itself to 0.91 m rms (cooperative); alone: 61 m rms, 138 m at the end, after 2.81 km.`
std::vector<std::string> findings_in_words(const std::vector<RunMetric>& metrics);
/// Describes the contacts between bodies: `auv4 hits rock at 105.7 s, 3 times in all.`
std::vector<std::string> contacts_in_words(const RunRecord& run);

/// Returns a length in a readable unit: `0.91 m`, `138 m`, `2.81 km`.
std::string length_text(double length_m);

}  // namespace experiment
