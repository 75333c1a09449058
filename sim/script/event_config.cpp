// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/event_config.hpp"

#include <algorithm>
#include <sstream>

#include "sim/config/message_text.hpp"

namespace sim {

namespace {

constexpr const char* forms =
    "VEHICLE enters ZONE, VEHICLE leaves ZONE, VEHICLE inside ZONE, NAME touches NAME, VEHICLE faster than MPS, "
    "message on CHANNEL, event NAME fires (VEHICLE or NAME may be 'any')";

/// Parser of the words of a condition; `good` becomes false at the first error, which is reported.
class ConditionParser {
 public:
  ConditionParser(ParamReader& in, const char* key, const std::string& text) : in_(in), key_(key) {
    std::istringstream stream(text);
    for (std::string word; stream >> word;) words_.push_back(word);
  }

  bool parse(Condition& condition) {
    // Conditions with their own forms.
    if (words_.size() == 3 && words_[0] == "message" && words_[1] == "on") return message(condition);
    if (words_.size() == 3 && words_[0] == "event" && words_[2] == "fires") {
      condition = {Condition::Kind::fires, words_[1], "", 0};
      return check("event", words_[1], false);
    }
    if (words_.size() == 4 && words_[1] == "faster" && words_[2] == "than") return faster(condition);
    if (words_.size() != 3) return false;
    // Conditions of the form SUBJECT VERB OBJECT.
    condition.subject = words_[0];
    condition.object = words_[2];
    if (words_[1] == "touches") {
      condition.kind = Condition::Kind::touches;
      return check(movable_kind, words_[0], true) && check(movable_kind, words_[2], true);
    }
    if (words_[1] == "enters")
      condition.kind = Condition::Kind::enters;
    else if (words_[1] == "leaves")
      condition.kind = Condition::Kind::leaves;
    else if (words_[1] == "inside")
      condition.kind = Condition::Kind::inside;
    else
      return false;
    return check("vehicle", words_[0], true) && check("zone", words_[2], false);
  }

 private:
  bool message(Condition& condition) {
    condition = {Condition::Kind::message, words_[2], "", 0};
    if (words_[2].size() > Bus::max_channel_length)
      in_.error(key_, "a channel must have 1 to 63 characters, got " + std::to_string(words_[2].size()));
    return true;
  }

  bool faster(Condition& condition) {
    condition = {Condition::Kind::faster, words_[0], "", 0};
    // The number is read with the rules and messages of a key.
    const ConfigNode map = map_node("faster than", scalar_node(words_[3], in_.node()->find(key_)->place));
    ParamReader number(map, in_.who(), in_.diagnostics());
    number.read("faster than", condition.speed_mps, at_least(0), "");
    return check("vehicle", words_[0], true);
  }

  /// Reports an unknown name.  Returns true, because the form is valid for any name.
  bool check(const char* kind, const std::string& name, bool any_allowed) {
    if (any_allowed && name == "any") return true;
    const std::vector<std::string> known = in_.declared(kind);
    if (!std::binary_search(known.begin(), known.end(), name))
      in_.error(key_, "'" + std::string(key_) + "' names no " + kind + " '" + shortened(printable(name)) + "'; known " +
                          plural_of(kind) + ": " + list_text(known));
    return true;
  }

  ParamReader& in_;
  const char* key_;
  std::vector<std::string> words_;
};

}  // namespace

Condition parse_condition(ParamReader& in, const char* key) {
  std::string text;
  in.read(key, text, "condition, see docs/guides/dynamic_worlds.md; it fires every time this becomes true");
  Condition condition;
  if (!in.has(key) || in.child(key)->kind != ConfigNode::Kind::scalar) return condition;
  if (!ConditionParser(in, key, text).parse(condition))
    in.error(key, "'" + std::string(key) + "' must be one of: " + forms + "; got '" + shortened(printable(text)) + "'");
  return condition;
}

void EventConfig::read(ParamReader& in) {
  if (in.node() != nullptr) place = in.node()->place;
  in.require("name");
  in.read_name("name", name, "name of the event, unique in the world; its random choices depend on it");
  read_times(in);
  when = parse_condition(in, "when");
  const int reasons = in.has("at") + in.has("every") + in.has("when");
  if (reasons > 1) in.error("needs one of 'at', 'every' and 'when', not several");
  for (const char* key : {"from_s", "until_s", "jitter_s"})
    if (in.has(key) && !in.has("every")) in.error(key, "'" + std::string(key) + "' belongs to 'every'");
  in.read("delay_s", delay_s, between(0, 1e9), "delay between firing and the actions");
  in.read_or_word("times", times, at_least(1), {"unlimited"},
                  "maximum number of firings; with 'at' at most the number of its times");
  // 'unlimited' of a list of times means each of them once.
  if (times == 0) times = static_cast<std::int64_t>(at_s.size());
  in.read("probability", probability, between(0, 1), "probability of firing");
  in.require("do");
  read_actions(in, "do", actions, "what happens, in this order: actions, each a map of one key, its type");
}

void EventConfig::read_times(ParamReader& in) {
  // Read `at`, a number or a list.
  if (in.describing()) {
    ParamInfo info;
    info.key = "at";
    info.type = "number or list of numbers";
    info.rule = at_least(0).text();
    info.initial = "[]";
    info.meaning = "simulated times, s, at which it fires";
    in.describe(std::move(info));
  } else if (const ConfigNode* at = in.child("at"); at != nullptr && at->kind == ConfigNode::Kind::list) {
    in.read("at", at_s, between(0, 1e9), "");
  } else if (at != nullptr) {
    at_s.resize(1);
    in.read("at", at_s[0], between(0, 1e9), "");
  }
  std::sort(at_s.begin(), at_s.end());
  // Read the keys of periodic firing.
  std::optional<double> from, until;
  in.read("every", every_s, between(1e-6, 1e9), "seconds from firing to firing");
  in.read("from_s", from, between(0, 1e9), "every: time of the first firing; unset: after one period");
  in.read("until_s", until, between(0, 1e9), "every: time of the last possible firing");
  in.read("jitter_s", jitter_s, between(0, 1e9), "every: each firing is later by up to this, at random");
  from_s = from.value_or(every_s);
  if (until) until_s = *until;
  if (in.has("every") && jitter_s > every_s) in.error("jitter_s", "'jitter_s' must not be longer than 'every'");
}

}  // namespace sim
