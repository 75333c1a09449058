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

/// Reads the keys of one YAML map into a struct, or (when describing) collects the descriptions of the keys.  A struct
/// names each key, its range and its meaning once, in its `read`.  Members hold the defaults.  Errors are collected,
/// never thrown: after an error the member keeps its default.
class ParamReader {
 public:
  /// Makes a reader of `node`.  `who`: prefix of each message, such as `vehicle 'auv1': device 'lidar'`.
  ParamReader(const ConfigNode& node, std::string who, Diagnostics& diagnostics);
  /// Makes a describing reader: every call appends to `table`; members are unchanged.
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
  /// Reads a number inside `rule`, or a word such as `duration_s: forever`, which sets `word.value`.  That number
  /// itself is an error, which names the word.
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
  /// Reads a list of numbers of any length, each inside `rule`.
  void read(const char* key, std::vector<double>& value, const Rule& rule, const char* meaning);
  /// Reads a list of texts.
  void read(const char* key, std::vector<std::string>& value, const char* meaning);
  /// Reads a name of letters, digits, '_' and '-', which may become part of a channel or file name.
  void read_name(const char* key, std::string& value, const char* meaning);
  /// Reads the path of a file.  A file to be read is relative to the file that holds this map; one to be created (a
  /// serial port) to the folder of the run.  Reports an error and returns false when the path comes over the bus, or
  /// when the FileAccess of the diagnostics does not allow it; paths set on the command line are allowed.  The value is
  /// kept as it was written.
  bool read_path(const char* key, std::string& value, PathUse use, const char* meaning);
  /// Reads a list of libraries, which are looked up by their loader.
  void read_paths(const char* key, std::vector<std::string>& value, const char* meaning);
  /// Reads an angle in degrees (key ends in `_deg`) and stores it in radians; `rule` is in degrees.
  void read_deg(const char* key, double& value_rad, const Rule& rule, const char* meaning);
  /// Reads three angles in degrees and stores them in radians.
  void read_deg(const char* key, Vector3d& value_rad, const char* meaning);
  /// Reads one word of an enum.
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void read_choice(const char* key, Enum& value, const std::type_identity_t<ChoiceWords<Enum>>& words,
                   const char* meaning);
  /// Reads one word of an enum, or `word_of_none`, listed first, which clears `value`.
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void read_choice(const char* key, std::optional<Enum>& value, const char* word_of_none,
                   const std::type_identity_t<ChoiceWords<Enum>>& words, const char* meaning);
  /// Reads one word of an enum; only the values in `allowed` are accepted.
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void read_choice(const char* key, Enum& value, const std::type_identity_t<ChoiceWords<Enum>>& words,
                   std::span<const std::type_identity_t<Enum>> allowed, const char* meaning);
  /// Reads one name of a list that is known only at run time or selects a row of a table: registered types, presets.  A
  /// word that selects program behavior belongs to an enum, see read_choice.
  void read_one_of(const char* key, std::string& value, const std::vector<std::string>& names, const char* meaning);
  /// Reads a name that must have been declared by `declare(kind, name)`.  Empty (the default) means none.
  void read_reference(const char* key, std::string& value, const char* kind, const char* meaning);
  /// Reads a list of names, each as by read_reference().
  void read_references(const char* key, std::vector<std::string>& value, const char* kind, const char* meaning);
  /// Makes the next read of `key` report an error when the key is absent: `missing key 'file'`.
  void require(const char* key);
  /// Stores a map that is read elsewhere (overrides, the environment of a process) unchanged.
  void read_raw(const char* key, ConfigNode& value, const char* meaning);

  // A key without a value (`parts:` and nothing after it) is an empty map or list, or an unset optional.

  /// Reads a nested map.  `key` is passed to set_key() of a T that has it, whether the key is present or not.
  template <ReadsParams T>
  void read(const char* key, T& value, const char* meaning);
  /// Reads a nested map that may be absent; without the key `value` stays unset.
  template <ReadsParams T>
  void read(const char* key, std::optional<T>& value, const char* meaning);
  /// Reads a list of maps.  Messages denote an item as `kind 'name'` when it has a `name`, else as `kind 3` (from 1).
  template <ReadsParams T>
  void read_list(const char* key, std::vector<T>& value, const char* kind, const char* meaning);
  /// Reads a list of lists of maps.  Adds no description.
  template <ReadsParams T>
  void read_lists(const char* key, std::vector<std::vector<T>>& value, const char* kind);

  /// Declares a name for read_reference in this reader and the readers nested in it.  Declaring the same name of a kind
  /// twice in one reader is an error: `duplicate joint 'left'`.
  void declare(const char* kind, const std::string& name);
  /// Returns the declared names of a kind, sorted.
  std::vector<std::string> declared(const char* kind) const;

  /// Reports an error at the value of `key`, or at the map when the key is absent.
  void error(const char* key, const std::string& text);
  /// Reports an error at the map itself.
  void error(const std::string& text);

  /// Returns whether this reader collects descriptions instead of values.
  bool describing() const { return table_ != nullptr; }
  /// Returns whether the map has this key; false when describing.
  bool has(const char* key) const;
  /// Returns the map that is read; null when describing.
  const ConfigNode* node() const { return node_; }
  /// Returns the node of a key, null when absent, and marks the key as known.
  const ConfigNode* child(const char* key);
  /// Prefix of each error message, such as `vehicle 'auv1': device 'lidar'`.
  const std::string& who() const { return who_; }
  /// Returns the collection of errors.
  Diagnostics& diagnostics() { return *diagnostics_; }
  /// Adds a row to the table when describing (for keys that are read by hand through child()).
  void describe(ParamInfo info);

  /// Reports unknown keys: `unknown key 'beam'; known keys: beams, fov_deg`.  Must be called once, after the last read.
  void finish();

 private:
  /// Place of a named item of a list, for errors such as `duplicate joint 'left'`.
  struct NamedPlace {
    std::string kind;  ///< empty: an item of a list of text
    std::string name;
    SourcePlace place;
  };
  using ReadInto = std::function<void(ParamReader&)>;

  ParamReader(const ConfigNode& node, std::string who, Diagnostics& diagnostics, const ParamReader* parent);
  ParamReader(std::vector<ParamInfo>& table, const ParamReader* parent, const void* type);

  /// Returns the value of `key`, null when absent, and marks the key as known.  Reports a required key that is absent.
  const ConfigNode* take(const char* key);
  void describe_value(const char* key, ParamKind kind, const Rule& range, std::string initial, const char* meaning);
  void describe_or_word(const char* key, ParamKind kind, const Rule& range, const NumberWord& word, double initial,
                        const char* meaning);
  /// Describes text whose rule is not a range: `choices`, or names.
  void describe_words(const char* key, ParamKind kind, std::string rule, std::string initial, const char* meaning,
                      std::vector<std::string> choices = {});
  void error_at(const SourcePlace& place, const std::string& text);
  bool take_number(const std::string& what, const ConfigNode& node, const Rule& rule, double& value);
  /// Returns the node of a key that holds a number; null when it holds the word, which sets `value`, or is wrong.
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

  /// Returns the descriptions of nested keys.  `type` identifies the type, so that describing a recursive type
  /// terminates.
  std::vector<ParamInfo> describe_children(const void* type, const ReadInto& read_into) const;
  void describe_nested(const char* key, ParamKind kind, const std::string& initial, const void* type,
                       const ReadInto& read_into, const char* meaning);
  void read_nested(const char* key, const ConfigNode& node, const ReadInto& read_into);
  /// Calls `read_into` for each item of the list.  Returns false when the value is not a list.
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
