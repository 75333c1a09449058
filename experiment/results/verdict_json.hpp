// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "experiment/score/rule_verdict.hpp"

namespace experiment {

/// Returns an entry of `rules` in summary.json and study.json.
nlohmann::ordered_json json_of(const RuleVerdict& verdict);

}  // namespace experiment
