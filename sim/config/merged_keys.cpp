// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/merged_keys.hpp"

#include <algorithm>
#include <map>

namespace sim {

std::vector<ParamInfo> merged_keys(const std::vector<std::pair<std::string, std::vector<ParamInfo>>>& types) {
  std::vector<ParamInfo> keys;
  std::map<std::string, std::vector<std::string>> owners;
  for (const auto& [word, table] : types)
    for (const ParamInfo& info : table) {
      owners[info.key].push_back(word);
      const auto same = [&](const ParamInfo& other) { return other.key == info.key; };
      if (std::any_of(keys.begin(), keys.end(), same)) continue;
      keys.push_back(info);
      ParamInfo& merged = keys.back();
      const bool is_text = merged.kind == ParamKind::text || merged.kind == ParamKind::name;
      if (merged.required && is_text && merged.choices.empty()) merged.initial = "\"\"";  // for types without this key
      merged.required = false;
    }
  for (ParamInfo& info : keys) {
    const std::vector<std::string>& whose = owners[info.key];
    if (whose.size() == 2) info.meaning = whose[0] + ", " + whose[1] + ": " + info.meaning;
    if (whose.size() == 1 && whose[0] != info.key) info.meaning = whose[0] + ": " + info.meaning;
  }
  return keys;
}

}  // namespace sim
