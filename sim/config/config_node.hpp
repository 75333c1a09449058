// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/config/diagnostics.hpp"

namespace sim {

/// A node of a YAML document that knows where it was written, also after files were merged.
struct ConfigNode {
  enum class Kind { null, scalar, list, map };
  struct Entry;

  Kind kind = Kind::null;
  bool quoted = false;    ///< a scalar in quotes: always text, never a number
  bool verbatim = false;  ///< a scalar that stands in its file as it is: on one line, without escapes
  std::string scalar;
  std::vector<ConfigNode> items;  ///< of a list
  std::vector<Entry> entries;     ///< of a map, in file order, keys unique
  SourcePlace place;

  const ConfigNode* find(std::string_view key) const;
  ConfigNode* find(std::string_view key);
};

struct ConfigNode::Entry {
  std::string key;
  SourcePlace place;  ///< of the key
  ConfigNode value;
};

/// The place of one character of a scalar, counted from 0; where the scalar is not verbatim, the place of the scalar.
SourcePlace place_in(const ConfigNode& scalar, std::size_t offset);

/// A plain scalar, as if it were written at `place`.
ConfigNode scalar_node(const std::string& text, const SourcePlace& place);
/// Marks the values and keys of a tree with their origin.
void set_origin(ConfigNode& node, Origin origin);
/// A map of one key, so that a value is read with the rules and messages of a key.
ConfigNode map_node(const std::string& key, const ConfigNode& value);

/// Parses one YAML document.  Syntax errors, duplicate keys, a second document, documents nested too deeply or
/// with too many nodes (aliases expanded) go to `diagnostics`; the result is then a null node.
ConfigNode parse_config_text(const std::string& text, const std::string& file_name, Diagnostics& diagnostics);

/// Reads a file and the files its `include:` key names (a file name or a list of them, relative to the file).
/// An included file is the base over which the including file is merged: maps key by key, lists of maps that
/// have a `name` item by item by that name, anything else replaced.  Missing files, files over 64 MB, cyclic
/// includes, an empty file and one that is not a map are errors.
/// `named_by`: Origin::command_line for a file that is quoted in errors.  Files that it includes must be allowed by the
/// FileAccess of the diagnostics.  Where there is one, a file that the command line does not name is quoted only when
/// its top level has nothing but keys of worlds and vehicles; other errors say line and column.
ConfigNode load_config_file(const std::string& path, Diagnostics& diagnostics, Origin named_by = Origin::command_line);

/// Sets the value at a dotted path, such as `vehicles.rover1.devices.lidar.rate_hz`.  An item of a list is named
/// by its `name` or its index; maps are created on the way where a key is missing.  `value` is YAML text.  Errors
/// (a list item that does not exist, a path through a scalar) go to `diagnostics` at `place`.
void set_config_path(ConfigNode& root, std::string_view path, const ConfigNode& value, const SourcePlace& place,
                     Diagnostics& diagnostics);

/// Replaces every `${name}` in the scalars below `node` by the scalar of that name in `parameters`.  A scalar that
/// is nothing but `${name}` takes the parameter's node, so that numbers and lists stay what they are.  Unknown names
/// are errors that list the known ones.
void substitute_parameters(ConfigNode& node, const std::vector<std::pair<std::string, ConfigNode>>& parameters,
                           const std::string& who, Diagnostics& diagnostics);

/// The text of `name` in an item of a list; null when the item is not a map or lacks the key.
const std::string* name_of(const ConfigNode& item);

/// YAML text of the tree, which parses to the same tree.
std::string to_yaml(const ConfigNode& node);

}  // namespace sim
