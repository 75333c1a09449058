// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/action.hpp"

#include "sim/config/message_text.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/script/old_action.hpp"

namespace sim {

namespace {

void describe_actions(ParamReader& in) {
  std::vector<std::pair<std::string, std::vector<ParamInfo>>> types;
  for (const ActionKind* kind : ActionRegistry::instance().all()) types.emplace_back(kind->word, kind->keys());
  for (ParamInfo& info : merged_keys(types)) in.describe(std::move(info));
}

}  // namespace

void ActionEntry::read(ParamReader& in) {
  if (in.describing()) return;  // see read_actions
  place = in.node()->place;
  who = in.who();
  if (in.node()->kind != ConfigNode::Kind::map) return;  // was reported
  for (const ConfigNode::Entry& entry : in.node()->entries) in.child(entry.key.c_str());
  const ActionKind* kind = find_kind(in);
  if (kind == nullptr) return;
  const ConfigNode& value = in.node()->entries.front().value;
  const char* word = kind->word.c_str();
  if (value.kind != ConfigNode::Kind::map && !kind->main_alone)
    return in.error(word,
                    "'" + kind->word + "' must be a map with the keys " + keys_text(*kind) + ", got " + shown(value));
  action = kind->make();
  if (value.kind != ConfigNode::Kind::map) return action->read(in, word);
  ActionKeys keys{*action, kind->main_key};
  in.read(word, keys, "");
}

void read_actions(ParamReader& in, const char* key, std::vector<ActionEntry>& actions, const char* meaning) {
  if (!in.describing()) return in.read_list(key, actions, "action", meaning);
  ParamInfo info;
  info.key = key;
  info.type = type_text(ParamKind::maps);
  info.initial = "[]";
  info.meaning = meaning;
  info.kind = ParamKind::maps;
  info.may_be_null = true;
  info.one_key = true;
  info.definition = definition;
  for (const ActionKind* kind : ActionRegistry::instance().all()) info.children.push_back(kind->info());
  in.describe(std::move(info));
}

void read_action_lists(ParamReader& in, const char* key, std::vector<std::vector<ActionEntry>>& lists,
                       const char* meaning) {
  if (!in.describing()) return in.read_lists(key, lists, "action");
  ParamInfo info;
  info.key = key;
  info.type = type_text(ParamKind::lists);
  info.initial = "[]";
  info.meaning = meaning;
  info.kind = ParamKind::lists;
  info.one_key = true;
  info.definition = definition;
  in.describe(std::move(info));
}

std::vector<std::string> names_added_by(const ConfigNode& actions) {
  std::vector<std::string> names;
  const auto append = [&](const ConfigNode& node) {
    for (std::string& name : names_added_by(node)) names.push_back(std::move(name));
  };
  for (const ConfigNode& item : actions.items) append(item);
  for (const ConfigNode::Entry& entry : actions.entries) {
    const ConfigNode* object = entry.key == "add" ? entry.value.find("object") : nullptr;
    const ConfigNode* name = object != nullptr ? object->find("name") : nullptr;
    if (name != nullptr && name->kind == ConfigNode::Kind::scalar) names.push_back(name->scalar);
    append(entry.value);
  }
  return names;
}

}  // namespace sim
