// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/choice_words.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Type of the value of an argument.
enum class ArgType {
  number,
  integer,
  text,
  flag,     ///< true or false; false unless given
  choice,   ///< one word of a list
  numbers,  ///< a list of numbers
  tuple,    ///< a list with a number for each column
  tuples    ///< a list of such lists
};

/// Words of the types in a declaration.
inline constexpr ChoiceWords<ArgType> arg_type_words{
    {"number", ArgType::number}, {"integer", ArgType::integer}, {"text", ArgType::text},   {"flag", ArgType::flag},
    {"choice", ArgType::choice}, {"numbers", ArgType::numbers}, {"tuple", ArgType::tuple}, {"tuples", ArgType::tuples}};

/// Declaration of one argument of a program.
struct ArgDeclaration {
  std::string name;  ///< with its unit: `speed_mps`
  ArgType type = ArgType::text;
  Rule range;                        ///< range of each number
  std::vector<std::string> choices;  ///< words of a choice
  std::vector<std::string> columns;  ///< names of the numbers of a tuple
  int min_columns = 0;               ///< number of required columns; 0: all are required
  bool required = false;
  std::optional<ConfigNode> initial;  ///< default value; unset: the meaning describes the behavior
  std::vector<std::string> needs;     ///< arguments that must be given with this one
  std::string meaning;

  void read(ParamReader& in);
  /// Returns the minimum number of columns of a tuple.
  std::size_t needed_columns() const;
};

/// Declaration of the arguments of a program, from its file NAME.args.yaml.  The format is described in
/// docs/guides/program_arguments.md.
struct ProgramDeclaration {
  int shoal_args = 1;  ///< version of the format
  std::string program;
  std::string meaning;
  std::optional<std::vector<std::string>> publishes,
      subscribes;  ///< channels, with {name} for an argument; unset: unknown
  std::vector<ArgDeclaration> args;
  std::vector<std::vector<std::string>> exactly_one;  ///< groups of arguments of which one must be given
  std::vector<std::vector<std::string>> at_most_one;  ///< groups of arguments of which one may be given

  void read(ParamReader& in);
  const ArgDeclaration* find(const std::string& name) const;
};

/// Reads a declaration.  `file`: its name in errors, which are reported to `diagnostics`.
ProgramDeclaration read_declaration(const std::string& text, const std::string& file, Diagnostics& diagnostics);

/// Returns the text of NAME.args.yaml, which parses to the same declaration.
std::string to_yaml(const ProgramDeclaration& declaration);

/// Returns the arguments as rows of a table of keys.
std::vector<ParamInfo> param_table_of(const ProgramDeclaration& declaration);

}  // namespace sim
