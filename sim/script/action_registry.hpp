// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/script/action.hpp"

namespace sim {

/// Type of action, identified by its word in YAML.
struct ActionKind {
  std::string word;      ///< its key in the list
  std::string meaning;   ///< one line: what it does
  const char* main_key;  ///< main key of its map, such as `channel` of publish
  bool main_alone;       ///< the value of the main key may replace the map: `log: text`
  std::function<std::shared_ptr<Action>()> make;

  /// Returns the keys of its map, the main one first.
  std::vector<ParamInfo> keys() const;
  /// Returns the word of the action and its keys.
  ParamInfo info() const;
};

/// Registry of all types of actions, filled before main by SHOAL_ACTION, and by plugins when they are loaded.
class ActionRegistry {
 public:
  static ActionRegistry& instance();
  /// Registers a type.  Two types with the same word are a programming error.
  void add(ActionKind kind);
  /// Returns the type with this word; null when there is none.
  const ActionKind* find(const std::string& word) const;
  /// Returns all types, sorted by word.
  std::vector<const ActionKind*> all() const;
  std::vector<std::string> words() const;

 private:
  std::vector<std::unique_ptr<ActionKind>> kinds_;
};

namespace detail {

template <typename Model>
bool add_action(const char* word) {
  ActionRegistry::instance().add(
      {word, Model::meaning, Model::main_key, Model::main_alone, [] { return std::make_shared<Model>(); }});
  return true;
}

}  // namespace detail

/// Registers a type of action, in its own file.  Model is an Action with `static constexpr const char* meaning` and
/// `main_key`, and `static constexpr bool main_alone`; see ActionKind.
#define SHOAL_ACTION(word, Model) \
  [[maybe_unused]] static const bool registered_##Model = ::sim::detail::add_action<Model>(word)

}  // namespace sim
