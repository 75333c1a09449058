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
struct ObjectConfig;

/// Function that encodes a map of values as a message of a type; errors are reported to the diagnostics.  sim/ does not
/// depend on message types: the program that loads a world supplies this function.
using EncodeMessage = std::function<Bytes(const std::string& type, const ConfigNode& value, Diagnostics&)>;

/// Action of an event with its parameters.  Its type is registered by SHOAL_ACTION (sim/script/action_registry.hpp).
class Action {
 public:
  virtual ~Action() = default;
  /// Reads its keys, the main one first.  `main`: the name of that key, such as `channel` in
  /// `publish: {channel: c, type: t}`; the word of the action when a value replaces the map, as in `log: text`.  Names
  /// must be declared as `vehicle`, `object`, `vehicle or object`, `actor`, `event`.
  virtual void read(ParamReader& in, const char* main) = 0;
  /// Reports errors that can be found only when all vehicles of the world are loaded, and prepares data common to all
  /// firings.
  virtual void check(const ActionCheck& /*check*/) {}
  /// Executes the action.  Throws on failure; the event then continues with its next action.
  virtual void carry_out(const ActionRun& run) const = 0;
  /// Adds the channels that it publishes on.
  virtual void add_channels(std::set<std::string>& /*channels*/) const {}
  /// Adds the names of the events that it triggers.
  virtual void add_triggered(std::set<std::string>& /*events*/) const {}
  /// Adds the objects that it describes itself, for warnings.
  virtual void add_objects(std::vector<const ObjectConfig*>& /*objects*/) const {}
};

/// Action in the list of an event.  In YAML a map with one key, the word of the action, whose value is a map with the
/// keys of the action, or the value of its main key alone.
struct ActionEntry {
  SourcePlace place;
  std::string who;                 ///< for messages, such as `event 'night': action 2`
  std::shared_ptr<Action> action;  ///< null: it could not be read, and an error was reported

  void read(ParamReader& in);
};

/// Reads a list of actions.
void read_actions(ParamReader& in, const char* key, std::vector<ActionEntry>& actions, const char* meaning);
/// Reads a list of lists of actions.
void read_action_lists(ParamReader& in, const char* key, std::vector<std::vector<ActionEntry>>& lists,
                       const char* meaning);

/// Kind of the entities that can be moved and removed.
inline constexpr const char* movable_kind = "vehicle or object";

/// Returns the names of the objects added by `add` actions anywhere below.
std::vector<std::string> names_added_by(const ConfigNode& actions);

}  // namespace sim
