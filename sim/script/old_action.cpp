// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/old_action.hpp"

#include <algorithm>
#include <set>

#include "sim/config/message_text.hpp"
#include "sim/config/yaml_writer.hpp"

namespace sim {

namespace {

std::string cut_value(const ConfigNode& value) {
  constexpr std::size_t max = 30;
  const std::string text = to_flow_yaml(value, max + 1);
  if (text.size() <= max) return text;
  if (value.kind == ConfigNode::Kind::map) return "{...}";
  if (value.kind == ConfigNode::Kind::list) return "[...]";
  return shortened(text, max);
}

}  // namespace

bool has_keys_of(const ConfigNode& value, const ActionKind& kind) {
  const std::vector<ParamInfo> keys = kind.keys();
  std::set<std::string> seen;
  return std::all_of(value.entries.begin(), value.entries.end(), [&](const ConfigNode::Entry& entry) {
    return seen.insert(entry.key).second &&
           std::any_of(keys.begin(), keys.end(), [&](const ParamInfo& info) { return info.key == entry.key; });
  });
}

ConfigNode new_form_of(const ConfigNode& action, const ActionKind& kind) {
  ConfigNode keys;
  keys.kind = ConfigNode::Kind::map;
  keys.place = action.place;
  for (const ConfigNode::Entry& entry : action.entries) {
    const bool is_word = entry.key == kind.word;
    // `move: {one_of: [a, b]}` has keys of the action; the value of `add: {name: b, parts: [...]}` is an object.
    if (is_word && entry.value.kind == ConfigNode::Kind::map && has_keys_of(entry.value, kind))
      keys.entries.insert(keys.entries.begin(), entry.value.entries.begin(), entry.value.entries.end());
    else if (is_word)
      keys.entries.insert(keys.entries.begin(), {kind.main_key, entry.place, entry.value});
    else
      keys.entries.push_back(entry);
  }
  return map_node(kind.word, keys);
}

std::string brief_text(const ConfigNode& map, std::size_t limit) {
  std::string whole = to_flow_yaml(map, limit + 1);
  if (whole.size() <= limit) return printable(whole.substr(1, whole.size() - 2));
  std::string text;
  for (const ConfigNode::Entry& entry : map.entries) {
    std::string keys;
    for (const ConfigNode::Entry& key : entry.value.entries)
      keys += (keys.empty() ? "" : ", ") + shortened(key.key) + ": " + cut_value(key.value);
    const bool is_map = entry.value.kind == ConfigNode::Kind::map;
    text +=
        (text.empty() ? "" : ", ") + shortened(entry.key) + ": " + (is_map ? "{" + keys + "}" : cut_value(entry.value));
  }
  return printable(shortened(text, 4 * limit));
}

}  // namespace sim
