// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace sim {

/// The range a number must lie in.
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
/// A coordinate in the world: within 1e7 m, beyond which a body counts as lost.
Rule any_place();
Rule at_least(double low);
Rule above(double low);
Rule at_most(double high);
Rule between(double low, double high);   ///< both ends allowed
Rule above_to(double low, double high);  ///< low excluded, high allowed

/// A word that a key takes instead of a number, for what no number says: `duration_s: forever`.
struct NumberWord {
  const char* word;
  double value = 0;  ///< what the program computes with; the rule of the key does not allow it
};

/// What the value of a key is.
enum class ParamKind {
  any,  ///< described by hand, nothing is known
  boolean,
  integer,
  number,
  text,
  name,  ///< text of letters, digits, '_' and '-'
  path,  ///< text that names a file; see ParamReader::read_path
  vector,
  numbers,
  texts,
  paths,  ///< a list of such
  map,
  maps,
  lists,  ///< a list of lists of maps
  raw     ///< a map that is read elsewhere
};

/// What happens to a file that a key names.
enum class PathUse {
  read,       ///< relative to the file that holds the key
  looked_up,  ///< in several folders, by whoever needs it: vehicle files, plugins
  made        ///< a serial port, relative to the folder of the run
};

/// As tables call it: `number`, `[x, y, z]`, `list of maps`.
std::string type_text(ParamKind kind);

/// What is known of one key: the source of error messages, `shoal describe`, docs and schemas.
struct ParamInfo {
  std::string key;
  std::string type;     ///< as type_text()
  std::string rule;     ///< as Rule::text(), or `one of: a, b`, or `name of a joint`
  std::string initial;  ///< default as YAML text; empty when required
  std::string meaning;
  bool required = false;
  std::vector<ParamInfo> children;  ///< keys of a map, or of each item of a list of maps

  // The same for programs.
  ParamKind kind = ParamKind::any;
  Rule range = {};                         ///< of each number
  std::vector<std::string> choices = {};   ///< the only words allowed; empty: any
  PathUse path_use = PathUse::read;        ///< of a path
  bool may_be_null = false;                ///< `key:` without a value is allowed
  std::string word = {};                   ///< instead of the number; see NumberWord
  bool one_key = false;                    ///< each map has one of the children and nothing else
  bool main_alone = false;                 ///< a value of the first child may stand for the map
  std::string definition = {};             ///< a name of the maps' keys; without children they are those of this name
  std::string pattern = {};                ///< regular expression (ECMA) that each text of a list matches; empty: any
  std::vector<std::string> examples = {};  ///< of such texts
};

}  // namespace sim
