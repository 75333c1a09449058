// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/config/diagnostics.hpp"

namespace sim {

/// Node of a YAML document with its place in the source file, which is kept when files are merged.
struct ConfigNode {
  enum class Kind { null, scalar, list, map };
  struct Entry;

  Kind kind = Kind::null;
  bool quoted = false;    ///< scalar in quotes: always text, never a number
  bool verbatim = false;  ///< scalar written literally in its file: on one line, without escapes
  std::string scalar;
  std::vector<ConfigNode> items;  ///< of a list
  std::vector<Entry> entries;     ///< of a map, in file order, keys unique
  SourcePlace place;

  // Defined once: compilers repeat it in a hundred objects otherwise.
  ConfigNode();
  ConfigNode(const ConfigNode&);
  ConfigNode(ConfigNode&&) noexcept;
  ConfigNode& operator=(const ConfigNode&);
  ConfigNode& operator=(ConfigNode&&) noexcept;
  ~ConfigNode();

  const ConfigNode* find(std::string_view key) const;
  ConfigNode* find(std::string_view key);
};

struct ConfigNode::Entry {
  std::string key;
  SourcePlace place;  ///< of the key
  ConfigNode value;
};

/// Returns the place of one character of a scalar, counted from 0; the place of the scalar when it is not verbatim.
SourcePlace place_in(const ConfigNode& scalar, std::size_t offset);

/// Makes a plain scalar with this place.
ConfigNode scalar_node(const std::string& text, const SourcePlace& place);
/// Sets the origin of all values and keys of a tree.
void set_origin(ConfigNode& node, Origin origin);
/// Returns whether a condition holds for the text of a scalar anywhere below.
template <typename Condition>
bool any_scalar(const ConfigNode& node, const Condition& condition) {
  return condition(node.scalar) ||
         std::any_of(node.items.begin(), node.items.end(),
                     [&](const ConfigNode& item) { return any_scalar(item, condition); }) ||
         std::any_of(node.entries.begin(), node.entries.end(),
                     [&](const ConfigNode::Entry& entry) { return any_scalar(entry.value, condition); });
}
/// Makes a map with one key, so that a value is read with the rules and messages of that key.
ConfigNode map_node(const std::string& key, const ConfigNode& value);

/// Parses one YAML document.  Syntax errors, duplicate keys, a second document, and documents nested too deeply or with
/// too many nodes (aliases expanded) are reported to `diagnostics`; the result is then a null node.
ConfigNode parse_config_text(const std::string& text, const std::string& file_name, Diagnostics& diagnostics);

/// Reads a file and the files its `include:` key names (a file name or a list of them, relative to the file).
/// An included file is the base over which the including file is merged: maps key by key, lists of maps that
/// have a `name` item by item by that name, anything else is replaced.  Missing files, files over 64 MB, cyclic
/// includes, empty files and files that are not a map are errors. `named_by`: Origin::command_line for a file that
/// errors may quote.  Included files must be allowed by the FileAccess of the diagnostics.  With a FileAccess, a file
/// that the command line does not name is quoted only when all keys of its top level are keys of worlds or vehicles;
/// other errors contain only line and column.
ConfigNode load_config_file(const std::string& path, Diagnostics& diagnostics, Origin named_by = Origin::command_line);

/// Sets the value at a dotted path, such as `vehicles.rover1.devices.lidar.rate_hz`.  An item of a list is selected by
/// its `name` or its index; missing maps along the path are created.  `value` is YAML text.  Errors (a list item that
/// does not exist, a path through a scalar) go to `diagnostics` at `place`.
void set_config_path(ConfigNode& root, std::string_view path, const ConfigNode& value, const SourcePlace& place,
                     Diagnostics& diagnostics);

/// Replaces every `${name}` in the scalars below `node` by the scalar of that name in `parameters`.  A scalar that
/// consists of `${name}` alone is replaced by the node of the parameter, so that numbers and lists keep their type.
/// Unknown names are errors that list the known ones.
void substitute_parameters(ConfigNode& node, const std::vector<std::pair<std::string, ConfigNode>>& parameters,
                           const std::string& who, Diagnostics& diagnostics);

/// Returns the text of `name` in an item of a list; null when the item is not a map or lacks the key.
const std::string* name_of(const ConfigNode& item);

/// Returns YAML text that parses to the same tree.
std::string to_yaml(const ConfigNode& node);

/// Parses the text of a file, as parse_config_text().  The trees of the last files are kept, for requests that spawn
/// many vehicles of a file: a file with the same name and text is not parsed again.  Thread-safe.
ConfigNode parse_file_text(const std::string& text, const std::string& path, Diagnostics& diagnostics);

/// Returns the tree as YAML on one line, such as `{name: left, axis: [0, 1, 0]}`.  Stops soon after `limit` bytes.
std::string to_flow_yaml(const ConfigNode& node, std::size_t limit = static_cast<std::size_t>(-1));

}  // namespace sim
