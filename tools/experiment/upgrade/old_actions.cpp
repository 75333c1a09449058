// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/old_actions.hpp"

#include <algorithm>

namespace tools {

std::span<const OldAction> old_actions() {
  static constexpr OldAction actions[] = {
      {"actor", "name"},    {"add", "object"},     {"clear_fault", "device"}, {"end", "reason"},
      {"fault", "device"},  {"log", "text"},       {"gravity_mps2", "value"}, {"move", "name"},
      {"set", "device"},    {"one_of", "choices"}, {"remove", "name"},        {"publish", "channel"},
      {"trigger", "event"},
  };
  return actions;
}

const OldAction* find_old_action(std::string_view word) {
  const auto all = old_actions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const OldAction& each) { return each.word == word; });
  return found == all.end() ? nullptr : &*found;
}

const SourceNode::Entry* word_of_action(const SourceNode& map) {
  const SourceNode::Entry* word = nullptr;
  for (const SourceNode::Entry& entry : map.entries) {
    if (find_old_action(entry.key.scalar) == nullptr) continue;
    if (word != nullptr) return nullptr;
    word = &entry;
  }
  return word;
}

}  // namespace tools
