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

/// What the value of an argument is.
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

/// The words for types in a declaration.
inline constexpr ChoiceWords<ArgType> arg_type_words{
    {"number", ArgType::number}, {"integer", ArgType::integer}, {"text", ArgType::text},   {"flag", ArgType::flag},
    {"choice", ArgType::choice}, {"numbers", ArgType::numbers}, {"tuple", ArgType::tuple}, {"tuples", ArgType::tuples}};

/// One argument of a program.
struct ArgDeclaration {
  std::string name;  ///< with its unit: `speed_mps`
  ArgType type = ArgType::text;
  Rule range;                        ///< of each number
  std::vector<std::string> choices;  ///< words of a choice
  std::vector<std::string> columns;  ///< names of the numbers of a tuple
  int min_columns = 0;               ///< the columns after these may be left out; 0: none may
  bool required = false;
  std::optional<ConfigNode>
      initial;                     ///< value of the argument when it is not given; unset: the meaning says what happens
  std::vector<std::string> needs;  ///< arguments that must be given with this one
  std::string meaning;

  void read(ParamReader& in);
  /// The number of columns that a tuple must have at least.
  std::size_t needed_columns() const;
};

/// What the arguments of a program are, as its file NAME.args.yaml says.  The format is explained in
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

/// Reads a declaration.  `file` is its name in errors, which go to `diagnostics`.
ProgramDeclaration read_declaration(const std::string& text, const std::string& file, Diagnostics& diagnostics);

/// The text of NAME.args.yaml, which reads back as the same declaration.
std::string to_yaml(const ProgramDeclaration& declaration);

/// The arguments as rows of a table of keys.
std::vector<ParamInfo> param_table_of(const ProgramDeclaration& declaration);

}  // namespace sim
