// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/choice_words.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/config/param_info.hpp"

namespace sim {

class ParamReader;

template <typename T>
concept ReadsParams = requires(T value, ParamReader& in) {
  value.read(in);
};

/// Hands the keys of one YAML map to a struct, or (describing) collects what the struct would read.  A struct names
/// each key, its range and its meaning once, in its `read`.  Members hold the defaults.  Errors are collected, never
/// thrown: after an error the member keeps its default.
class ParamReader {
 public:
  /// Reads `node`.  `who` is the start of each message, such as `vehicle 'auv1': device 'lidar'`.
  ParamReader(const ConfigNode& node, std::string who, Diagnostics& diagnostics);
  /// Describes: every call appends to `table`; members are left alone.
  explicit ParamReader(std::vector<ParamInfo>& table);
  ParamReader(const ParamReader&) = delete;
  ParamReader& operator=(const ParamReader&) = delete;

  /// Reads true or false.
  void read(const char* key, bool& value, const char* meaning);
  /// Reads a whole number inside `rule`.
  void read(const char* key, int& value, const Rule& rule, const char* meaning);
  /// Reads a whole number inside `rule`.
  void read(const char* key, std::int64_t& value, const Rule& rule, const char* meaning);
  /// Reads a finite number inside `rule`.
  void read(const char* key, double& value, const Rule& rule, const char* meaning);
  /// Reads a number that may be absent; without the key `value` stays unset.
  void read(const char* key, std::optional<double>& value, const Rule& rule, const char* meaning);
  /// Reads a number inside `rule`, or a word: `duration_s: forever`.  The value is then `word.value`; who writes that
  /// number itself is given the word.
  void read_or_word(const char* key, double& value, const Rule& rule, const NumberWord& word, const char* meaning);
  /// Reads a whole number, or a word.
  void read_or_word(const char* key, int& value, const Rule& rule, const NumberWord& word, const char* meaning);
  /// Reads a whole number, or a word.
  void read_or_word(const char* key, std::int64_t& value, const Rule& rule, const NumberWord& word,
                    const char* meaning);
  /// Reads text.
  void read(const char* key, std::string& value, const char* meaning);
  /// Reads a list of three numbers, each inside `rule`.
  void read(const char* key, Vector3d& value, const Rule& rule, const char* meaning);
  /// Reads a list of three numbers that may be absent; without the key `value` stays unset.
  void read(const char* key, std::optional<Vector3d>& value, const Rule& rule, const char* meaning);
  /// Any number of numbers, each inside `rule`.
  void read(const char* key, std::vector<double>& value, const Rule& rule, const char* meaning);
  /// Reads a list of texts.
  void read(const char* key, std::vector<std::string>& value, const char* meaning);
  /// A name, which may become part of a channel or a file name: letters, digits, '_' and '-'.
  void read_name(const char* key, std::string& value, const char* meaning);
  /// A file.  A file that is read is relative to the file that holds this map; one that is made (a serial port) to the
  /// folder of the run.  An error, and false, when it comes over the bus, or when the FileAccess of the diagnostics
  /// does not allow it; what the command line sets is allowed.  The value is kept as it was written.
  bool read_path(const char* key, std::string& value, PathUse use, const char* meaning);
  /// Libraries, which are looked up by their loader.
  void read_paths(const char* key, std::vector<std::string>& value, const char* meaning);
  /// A number in degrees in the file (key ends in `_deg`), in radians in the struct; `rule` is in degrees.
  void read_deg(const char* key, double& value_rad, const Rule& rule, const char* meaning);
  /// Three angles in degrees in the file, in radians in the struct.
  void read_deg(const char* key, Vector3d& value_rad, const char* meaning);
  /// Reads one word out of those of an enum.
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void read_choice(const char* key, Enum& value, const std::type_identity_t<ChoiceWords<Enum>>& words,
                   const char* meaning);
  /// Reads the same with a further word, listed first, for none of them.
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void read_choice(const char* key, std::optional<Enum>& value, const char* word_of_none,
                   const std::type_identity_t<ChoiceWords<Enum>>& words, const char* meaning);
  /// Reads one word out of those of an enum whose values are in `allowed`.
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void read_choice(const char* key, Enum& value, const std::type_identity_t<ChoiceWords<Enum>>& words,
                   std::span<const std::type_identity_t<Enum>> allowed, const char* meaning);
  /// Reads one name out of a list that is known only when the program runs, or has no meaning beyond its row of a
  /// table: registered types, presets.  A word that the program decides by belongs to an enum, see read_choice.
  void read_one_of(const char* key, std::string& value, const std::vector<std::string>& names, const char* meaning);
  /// A name that must have been announced by `declare(kind, name)`.  Empty (the default) means none.
  void read_reference(const char* key, std::string& value, const char* kind, const char* meaning);
  /// Reads a list of names, each as by read_reference().
  void read_references(const char* key, std::vector<std::string>& value, const char* kind, const char* meaning);
  /// The next read of `key` must find it: `missing key 'file'`.
  void require(const char* key);
  /// A map that is read elsewhere (overrides, a process's environment): kept as it is.
  void read_raw(const char* key, ConfigNode& value, const char* meaning);

  // A key without a value (`parts:` and nothing after it) is an empty map or list, or an unset optional.

  /// A nested map.  A T that has set_key() is given `key`, whether the key is present or not.
  template <ReadsParams T>
  void read(const char* key, T& value, const char* meaning);
  /// Reads a nested map that may be absent; without the key `value` stays unset.
  template <ReadsParams T>
  void read(const char* key, std::optional<T>& value, const char* meaning);
  /// A list of maps.  Who of an item: `kind 'name'` when the item has a `name`, else `kind 3` (from 1).
  template <ReadsParams T>
  void read_list(const char* key, std::vector<T>& value, const char* kind, const char* meaning);
  /// A list of such lists.  Describes nothing.
  template <ReadsParams T>
  void read_lists(const char* key, std::vector<std::vector<T>>& value, const char* kind);

  /// Makes a name known for read_reference in this reader and the readers nested in it.  The second time the same
  /// name of a kind is declared in one reader it is an error: `duplicate joint 'left'`.
  void declare(const char* kind, const std::string& name);
  /// The names of a kind known here, sorted.
  std::vector<std::string> declared(const char* kind) const;

  /// An error at the value of `key` (or at the map when the key is absent).
  void error(const char* key, const std::string& text);
  /// An error at the map itself.
  void error(const std::string& text);

  /// Whether this reader collects descriptions instead of values.
  bool describing() const { return table_ != nullptr; }
  /// The map has this key; false when describing.
  bool has(const char* key) const;
  /// The map that is read; null when describing.
  const ConfigNode* node() const { return node_; }
  /// The node of a key that is present.  Marks the key as known.
  const ConfigNode* child(const char* key);
  /// Start of each error message, such as `vehicle 'auv1': device 'lidar'`.
  const std::string& who() const { return who_; }
  /// Collects the errors and warnings.
  Diagnostics& diagnostics() { return *diagnostics_; }
  /// Adds a row to the table when describing (for keys that are read by hand through child()).
  void describe(ParamInfo info);

  /// Reports unknown keys: `unknown key 'beam'; known keys: beams, fov_deg`.  Call once, after the last read.
  void finish();

 private:
  /// A value of a list that has a name, for the place of `duplicate joint 'left'`.
  struct NamedPlace {
    std::string kind;  ///< empty: an item of a list of text
    std::string name;
    SourcePlace place;
  };
  using ReadInto = std::function<void(ParamReader&)>;

  ParamReader(const ConfigNode& node, std::string who, Diagnostics& diagnostics, const ParamReader* parent);
  ParamReader(std::vector<ParamInfo>& table, const ParamReader* parent, const void* type);

  /// The value of `key`, which becomes known; null when absent.  Reports it when it is required and absent.
  const ConfigNode* take(const char* key);
  void describe_value(const char* key, ParamKind kind, const Rule& range, std::string initial, const char* meaning);
  void describe_or_word(const char* key, ParamKind kind, const Rule& range, const NumberWord& word, double initial,
                        const char* meaning);
  /// Text whose rule is more than a range: `choices`, or names.
  void describe_words(const char* key, ParamKind kind, std::string rule, std::string initial, const char* meaning,
                      std::vector<std::string> choices = {});
  void error_at(const SourcePlace& place, const std::string& text);
  bool take_number(const std::string& what, const ConfigNode& node, const Rule& rule, double& value);
  /// The node of a key that has a number; null when it has the word, which `value` becomes, or an error.
  const ConfigNode* take_unless_word(const char* key, double& value, const Rule& rule, const NumberWord& word);
  bool take_integer(const std::string& what, const ConfigNode& node, const Rule& rule, std::int64_t& value);
  bool take_text(const std::string& what, const ConfigNode& node, std::string& value);
  bool take_vector(const char* key, const ConfigNode& node, const Rule& rule, Vector3d& value);
  bool take_texts(const char* key, const ConfigNode& node, std::vector<std::string>& value);
  bool check_path(const char* key, const std::string& value, PathUse use, const SourcePlace& place);
  void check_reference(const char* key, const char* kind, const std::string& name, const SourcePlace& place);
  std::size_t take_choice(const char* key, const std::vector<std::string>& choices, const std::string& initial,
                          const char* meaning);
  std::string who_of_item(const ConfigNode& item, const char* kind, std::size_t index) const;

  /// `type` identifies the type, so that describing a recursive type terminates.
  std::vector<ParamInfo> describe_children(const void* type, const ReadInto& read_into) const;
  void describe_nested(const char* key, ParamKind kind, const std::string& initial, const void* type,
                       const ReadInto& read_into, const char* meaning);
  void read_nested(const char* key, const ConfigNode& node, const ReadInto& read_into);
  /// Calls `read_into` for each item of the list.  False when the value is not a list.
  bool read_items(const char* key, const ConfigNode& node, const char* kind, const ReadInto& read_into);

  const ConfigNode* node_ = nullptr;
  std::string who_;
  Diagnostics unused_;  ///< while describing
  Diagnostics* diagnostics_ = nullptr;
  std::vector<ParamInfo>* table_ = nullptr;
  const ParamReader* parent_ = nullptr;
  const void* type_ = nullptr;  ///< while describing: see describe_children
  std::vector<std::string> known_;
  std::vector<std::string> required_;
  std::map<std::string, std::map<std::string, std::size_t>> declared_;  ///< kind, name, how often
  std::vector<NamedPlace> named_places_;
};

}  // namespace sim

#include "sim/config/param_reader_inl.hpp"
