// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/program/program_declaration.hpp"

namespace sim {

/// `--speed-mps` for `speed_mps`.
std::string option_of(const std::string& arg_name);

/// Reads the value of a tuple (as a list of one), or of a list of tuples or numbers.  Errors go to `diagnostics`.
std::vector<std::vector<double>> read_tuples(const ArgDeclaration& arg, const ConfigNode& value, const std::string& who,
                                             Diagnostics& diagnostics);

/// Checks one value and appends what it is on the command line: `--key=VALUE`, lists as JSON; `--key` for a flag that
/// is true, nothing for one that is false.
void append_words(const ArgDeclaration& arg, const ConfigNode& value, const std::string& who, Diagnostics& diagnostics,
                  std::vector<std::string>& words);

/// Checks the `args:` of a process against the declaration of its program, and gives the words of its command line
/// after the program, in the order of `args`.  `args` is a map or null; what is missing is an error at `place`.
std::vector<std::string> command_line_of(const ProgramDeclaration& declaration, const ConfigNode& args,
                                         const SourcePlace& place, const std::string& who, Diagnostics& diagnostics);

/// Replaces {name} in a channel of a declaration by the argument, or by its default.  Empty: the argument has no value.
std::string channel_of(const ProgramDeclaration& declaration, const ConfigNode& args, const std::string& pattern);

/// The value of an argument as text, or its default; empty: it has none.
std::string text_of_arg(const ProgramDeclaration& declaration, const ConfigNode& args, const std::string& name);

}  // namespace sim
