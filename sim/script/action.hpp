// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

class ActionCheck;
struct ActionRun;

/// Turns a map of values into the payload of a message type; what is wrong goes to the diagnostics.  sim/ knows no
/// message types: the program that loads a world brings this.
using EncodeMessage = std::function<Bytes(const std::string& type, const ConfigNode& value, Diagnostics&)>;

/// One thing that events do, with its values.  Its type is registered by SHOAL_ACTION (sim/script/action_registry.hpp).
class Action {
 public:
  virtual ~Action() = default;
  /// Reads its keys, the main one first.  `main`: the name of that key, such as `channel` in
  /// `publish: {channel: c, type: t}`; the action's word where a value stands for the map, as in `log: text`.  Names
  /// are those declared as `vehicle`, `object`, `vehicle or object`, `actor`, `event`.
  virtual void read(ParamReader& in, const char* main) = 0;
  /// Reports what shows only when all vehicles of the world are known, and makes what is made once for all firings.
  virtual void check(const ActionCheck& /*check*/) {}
  /// What is wrong is thrown, and the event continues with its next action.
  virtual void carry_out(const ActionRun& run) const = 0;
  /// Adds the channels that it publishes on.
  virtual void add_channels(std::set<std::string>& /*channels*/) const {}
  /// Adds the names of the events that it triggers.
  virtual void add_triggered(std::set<std::string>& /*events*/) const {}
};

/// An action in the list of an event.  In YAML a map of one key, the action's word, whose value is a map with the keys
/// of the action, or the value of its main key alone.
struct ActionEntry {
  SourcePlace place;
  std::string who;                 ///< for messages, such as `event 'night': action 2`
  std::shared_ptr<Action> action;  ///< null: it could not be read, which was reported

  void read(ParamReader& in);
};

/// A list of actions.
void read_actions(ParamReader& in, const char* key, std::vector<ActionEntry>& actions, const char* meaning);
/// A list of such lists.
void read_action_lists(ParamReader& in, const char* key, std::vector<std::vector<ActionEntry>>& lists,
                       const char* meaning);

/// `vehicle or object`: what can be moved and removed.
inline constexpr const char* movable_kind = "vehicle or object";

/// The names of the objects that `add` actions somewhere below bring.
std::vector<std::string> names_added_by(const ConfigNode& actions);

}  // namespace sim
