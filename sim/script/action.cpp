// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/action.hpp"

#include "sim/config/message_text.hpp"
#include "sim/script/action_registry.hpp"

namespace sim {

namespace {

/// Name of the definition in the schema.
constexpr const char* definition = "action";

/// Keys of an action in its map, as a type with read().
struct ActionKeys {
  Action& action;
  const char* main;
  void read(ParamReader& in) { action.read(in, main); }
};

std::string unknown_action(const std::string& word) {
  const std::vector<std::string> words = ActionRegistry::instance().words();
  return "unknown action '" + shortened(printable(word)) + "'; known actions: " + list_text(words) +
         did_you_mean(word, words);
}

/// Returns what belongs into the value of an action, for error messages.
std::string advice(const ActionKind& kind) {
  std::vector<std::string> keys;
  for (const ParamInfo& info : kind.keys()) keys.push_back(info.key);
  return ", whose value is a map; keys of '" + kind.word + "': " + list_text(keys);
}

/// Returns the action whose word is a key; reports an error and returns null when there is none or more than one.
const ActionKind* find_kind(ParamReader& in) {
  const std::vector<ConfigNode::Entry>& entries = in.node()->entries;
  const ActionKind* kind = nullptr;
  std::string other;
  // Find the words of actions among the keys.
  for (const ConfigNode::Entry& entry : entries) {
    const ActionKind* named = ActionRegistry::instance().find(entry.key);
    if (kind != nullptr && named != nullptr) other = entry.key;
    if (kind == nullptr) kind = named;
  }
  // Check that there is exactly one.
  if (entries.empty())
    in.error("an action must have exactly one key, its type, got {}; known actions: " +
             list_text(ActionRegistry::instance().words()));
  else if (kind == nullptr)
    in.error(unknown_action(entries.front().key));
  else if (!other.empty())
    in.error("an action must have exactly one key, its type, got '" + kind->word + "' and '" + other +
             "'; each action is an item of the list");
  else if (entries.size() > 1)
    in.error("an action must have exactly one key, its type" + advice(*kind));
  else
    return kind;
  return nullptr;
}

std::string keys_text(const ActionKind& kind) {
  std::vector<std::string> keys;
  for (const ParamInfo& info : kind.keys())
    if (info.required || keys.empty()) keys.push_back(info.key);
  return list_text(keys);
}

/// Describes a key whose value is a list of actions, or a list of such lists.
ParamInfo info_of_actions(const char* key, ParamKind kind, const char* meaning) {
  ParamInfo info;
  info.key = key;
  info.type = type_text(kind);
  info.initial = "[]";
  info.meaning = meaning;
  info.kind = kind;
  info.one_key = true;
  info.definition = definition;
  return info;
}

}  // namespace

void ActionEntry::read(ParamReader& in) {
  if (in.describing()) return;  // see read_actions
  place = in.node()->place;
  who = in.who();
  if (in.node()->kind != ConfigNode::Kind::map) return;  // already reported
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
  ParamInfo info = info_of_actions(key, ParamKind::maps, meaning);
  info.may_be_null = true;
  for (const ActionKind* kind : ActionRegistry::instance().all()) info.children.push_back(kind->info());
  in.describe(std::move(info));
}

void read_action_lists(ParamReader& in, const char* key, std::vector<std::vector<ActionEntry>>& lists,
                       const char* meaning) {
  if (!in.describing()) return in.read_lists(key, lists, "action");
  in.describe(info_of_actions(key, ParamKind::lists, meaning));
}

std::vector<std::string> names_added_by(const ConfigNode& actions) {
  std::vector<std::string> names;
  const auto append = [&](const ConfigNode& node) {
    for (std::string& name : names_added_by(node)) names.push_back(std::move(name));
  };
  // Actions can be nested in lists of others, such as choices.
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
