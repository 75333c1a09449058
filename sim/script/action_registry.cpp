// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/action_registry.hpp"

#include <algorithm>
#include <stdexcept>

namespace sim {

std::vector<ParamInfo> ActionKind::keys() const {
  std::vector<ParamInfo> table;
  ParamReader in(table);
  make()->read(in, main_key);
  return table;
}

ParamInfo ActionKind::info() const {
  ParamInfo info;
  info.key = word;
  info.meaning = meaning;
  info.children = keys();
  info.kind = ParamKind::map;
  info.main_alone = main_alone;
  const std::string& main = info.children.front().type;
  info.type = type_text(info.kind);
  if (main_alone) info.type = main.ends_with(info.type) ? main : main + " or " + info.type;
  return info;
}

ActionRegistry& ActionRegistry::instance() {
  static ActionRegistry registry;
  return registry;
}

void ActionRegistry::add(ActionKind kind) {
  if (find(kind.word) != nullptr) throw std::logic_error("action '" + kind.word + "' exists twice");
  const auto at = std::lower_bound(kinds_.begin(), kinds_.end(), kind.word,
                                   [](const auto& other, const std::string& word) { return other->word < word; });
  kinds_.insert(at, std::make_unique<ActionKind>(std::move(kind)));
}

const ActionKind* ActionRegistry::find(const std::string& word) const {
  for (const auto& kind : kinds_)
    if (kind->word == word) return kind.get();
  return nullptr;
}

std::vector<const ActionKind*> ActionRegistry::all() const {
  std::vector<const ActionKind*> all;
  for (const auto& kind : kinds_) all.push_back(kind.get());
  return all;
}

std::vector<std::string> ActionRegistry::words() const {
  std::vector<std::string> words;
  for (const auto& kind : kinds_) words.push_back(kind->word);
  return words;
}

}  // namespace sim
