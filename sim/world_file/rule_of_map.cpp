// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/rule_of_map.hpp"

#include <string_view>

namespace sim {

std::optional<std::string> scalar_of_key(const ConfigNode& map, const char* key) {
  const ConfigNode* value = map.find(key);
  if (value == nullptr || value->kind != ConfigNode::Kind::scalar || value->scalar.empty()) return std::nullopt;
  return value->scalar;
}

const OldComparison* only_comparison(const ConfigNode& map, const std::vector<OldComparison>& comparisons) {
  const OldComparison* only = nullptr;
  for (const OldComparison& each : comparisons) {
    if (map.find(each.key) == nullptr) continue;
    if (only != nullptr) return nullptr;
    only = &each;
  }
  return only;
}

std::optional<std::string> rule_of_map(const ConfigNode& map) {
  static const std::vector<OldComparison> comparisons{
      {"below", "<"}, {"above", ">"}, {"equals", "=="}, {"below_metric", "<"}, {"above_metric", ">"}};
  if (map.kind != ConfigNode::Kind::map) return std::nullopt;
  const auto metric = scalar_of_key(map, "metric");
  const OldComparison* comparison = only_comparison(map, comparisons);
  if (!metric || comparison == nullptr) return std::nullopt;
  const auto value = scalar_of_key(map, comparison->key);
  const bool of_metric = std::string_view(comparison->key).ends_with("_metric");
  if (!value || (map.find("factor") != nullptr && !of_metric)) return std::nullopt;
  const auto factor = scalar_of_key(map, "factor");
  return *metric + " " + comparison->sign + " " + (factor ? *factor + " * " : "") + *value;
}

}  // namespace sim
