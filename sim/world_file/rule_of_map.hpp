// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/config/config_node.hpp"

namespace sim {

/// Converts a rule in the form of version 0.1, `{metric: a.rms_m, below_metric: b.rms_m, factor: 0.4}`, to the present
/// form, `a.rms_m < 0.4 * b.rms_m`.  Returns none when the map is not such a rule.
std::optional<std::string> rule_of_map(const ConfigNode& map);

/// Returns the scalar of a key; none when it is missing, empty, or not a scalar.
std::optional<std::string> scalar_of_key(const ConfigNode& map, const char* key);

/// Key of version 0.1 and the comparison that it denoted.
struct OldComparison {
  const char* key;
  const char* sign;
};

/// Returns the only one of `comparisons` whose key is in the map; null when there are none or several.
const OldComparison* only_comparison(const ConfigNode& map, const std::vector<OldComparison>& comparisons);

}  // namespace sim
