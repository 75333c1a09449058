// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace sim {

/// Range in which a number must lie.
struct Rule {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;   ///< low itself is not allowed
  bool high_open = false;  ///< high itself is not allowed

  bool allows(double value) const;
  /// `>= 1`, `> 0`, `>= 0 and <= 360`; empty for any number.
  std::string text() const;
};

Rule any_number();
/// Range of a coordinate in the world: within 1e7 m; a body farther away counts as lost.
Rule any_place();
Rule at_least(double low);
Rule above(double low);
Rule at_most(double high);
Rule between(double low, double high);   ///< both ends allowed
Rule above_to(double low, double high);  ///< low excluded, high allowed

/// Word that a key accepts instead of a number, for a special value: `duration_s: forever`.
struct NumberWord {
  const char* word;
  double value = 0;  ///< value used by the program; outside the rule of the key
};

/// Kind of the value of a key.
enum class ParamKind {
  any,  ///< described by hand, unspecified
  boolean,
  integer,
  number,
  text,
  name,  ///< text of letters, digits, '_' and '-'
  path,  ///< text that names a file; see ParamReader::read_path
  vector,
  numbers,
  texts,
  paths,  ///< list of paths
  map,
  maps,
  lists,  ///< list of lists of maps
  raw     ///< map that is read elsewhere
};

/// Use of a file that a key names.
enum class PathUse {
  read,       ///< relative to the file that holds the key
  looked_up,  ///< searched in several folders by its loader: vehicle files, plugins
  made        ///< created: a serial port, relative to the folder of the run
};

/// Returns the name of a kind in tables: `number`, `[x, y, z]`, `list of maps`.
std::string type_text(ParamKind kind);

/// Description of one key: the source of error messages, `shoal describe`, documentation and schemas.
struct ParamInfo {
  std::string key;
  std::string type;     ///< as type_text()
  std::string rule;     ///< as Rule::text(), or `one of: a, b`, or `name of a joint`
  std::string initial;  ///< default as YAML text; empty when required
  std::string meaning;
  bool required = false;
  std::vector<ParamInfo> children;  ///< keys of a map, or of each item of a list of maps

  // The same in machine-readable form.
  ParamKind kind = ParamKind::any;
  Rule range = {};                        ///< of each number
  std::vector<std::string> choices = {};  ///< allowed words; empty: any
  PathUse path_use = PathUse::read;       ///< of a path
  bool may_be_null = false;               ///< `key:` without a value is allowed
  std::string word = {};                  ///< instead of the number; see NumberWord
  bool one_key = false;                   ///< each map has exactly one of the children
  bool main_alone = false;                ///< the value of the first child may be given instead of the map
  std::string definition = {};  ///< name for the keys of the maps; without children: refers to the keys of this name
  std::string pattern = {};     ///< regular expression (ECMA) that each text of a list matches; empty: any
  std::vector<std::string> examples = {};  ///< examples of texts that match
};

/// Merges the keys of several types into one table, each key once and none required.  `types`: word and keys of each
/// type.  The description of a key that belongs to one or two types names them, unless the key has the name of the
/// type.
std::vector<ParamInfo> merged_keys(const std::vector<std::pair<std::string, std::vector<ParamInfo>>>& types);

/// Returns key, type, rule, default and meaning of each key; nested keys are named by their paths as below.
std::vector<std::array<std::string, 5>> param_rows(const std::vector<ParamInfo>& params);

/// Returns the keys as a Markdown table: key, type, rule, default, meaning.  Keys of a map are written as
/// `noise.gaussian_std`, keys of the items of a list as `parts[].shape`.
std::string markdown_table(const std::vector<ParamInfo>& params);

/// Returns the same table as text in columns, for a terminal.
std::string text_table(const std::vector<ParamInfo>& params);

}  // namespace sim
