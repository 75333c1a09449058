// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/action.hpp"

#include "sim/config/merged_keys.hpp"
#include "sim/config/message_text.hpp"
#include "sim/script/action_registry.hpp"

namespace sim {

namespace {

void describe_actions(ParamReader& in) {
  std::vector<std::pair<std::string, std::vector<ParamInfo>>> types;
  for (const ActionKind* kind : ActionRegistry::instance().all()) types.emplace_back(kind->word, kind->keys());
  for (ParamInfo& info : merged_keys(types)) in.describe(std::move(info));
}

}  // namespace

void ActionEntry::read(ParamReader& in) {
  if (in.describing()) return describe_actions(in);
  place = in.node()->place;
  who = in.who();
  if (in.node()->kind != ConfigNode::Kind::map) return;  // was reported
  const std::string first = in.node()->entries.empty() ? "" : in.node()->entries.front().key;
  const ActionKind* kind = ActionRegistry::instance().find(first);
  if (kind == nullptr) {
    const std::vector<std::string> words = ActionRegistry::instance().words();
    const std::string meant = closest_name(first, words);
    in.error("unknown action '" + shortened(printable(first)) + "'; known actions: " + list_text(words) +
             (meant.empty() ? "" : "; did you mean '" + meant + "'?"));
    for (const ConfigNode::Entry& entry : in.node()->entries) in.child(entry.key.c_str());
    return;
  }
  action = kind->make();
  action->read(in);
}

std::vector<std::string> names_added_by(const ConfigNode& actions) {
  std::vector<std::string> names;
  const auto append = [&](const ConfigNode& node) {
    for (std::string& name : names_added_by(node)) names.push_back(std::move(name));
  };
  for (const ConfigNode& item : actions.items) append(item);
  for (const ConfigNode::Entry& entry : actions.entries) {
    const ConfigNode* name = entry.value.find("name");
    if (entry.key == "add" && name != nullptr && name->kind == ConfigNode::Kind::scalar) names.push_back(name->scalar);
    append(entry.value);
  }
  return names;
}

}  // namespace sim
