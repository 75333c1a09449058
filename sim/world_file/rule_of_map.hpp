// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/config/config_node.hpp"

namespace sim {

/// The rule that `{metric: a.rms_m, below_metric: b.rms_m, factor: 0.4}`, the form of version 0.1, becomes:
/// `a.rms_m < 0.4 * b.rms_m`.  Nothing when the map is no such rule.
std::optional<std::string> rule_of_map(const ConfigNode& map);

/// The scalar of a key; nothing when it is missing, empty, or no scalar.
std::optional<std::string> scalar_of_key(const ConfigNode& map, const char* key);

/// A key of version 0.1 and the comparison that it stood for.
struct OldComparison {
  const char* key;
  const char* sign;
};

/// The only one of `comparisons` whose key the map has; null when it has none or several.
const OldComparison* only_comparison(const ConfigNode& map, const std::vector<OldComparison>& comparisons);

}  // namespace sim
