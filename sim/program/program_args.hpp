// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/program/program_declaration.hpp"

namespace sim {

/// Returns the command line option of an argument: `--speed-mps` for `speed_mps`.
std::string option_of(const std::string& arg_name);

/// Reads the value of a tuple (as a list of one), or of a list of tuples or numbers.  Errors are reported to
/// `diagnostics`.
std::vector<std::vector<double>> read_tuples(const ArgDeclaration& arg, const ConfigNode& value, const std::string& who,
                                             Diagnostics& diagnostics);

/// Checks one value and appends its words of the command line: `--key=VALUE`, lists as JSON; `--key` for a true flag,
/// nothing for a false one.
void append_words(const ArgDeclaration& arg, const ConfigNode& value, const std::string& who, Diagnostics& diagnostics,
                  std::vector<std::string>& words);

/// Checks the `args:` of a process against the declaration of its program, and returns the words of its command line
/// after the program, in the order of `args`.  `args` is a map or null; a missing argument is an error at `place`.
std::vector<std::string> command_line_of(const ProgramDeclaration& declaration, const ConfigNode& args,
                                         const SourcePlace& place, const std::string& who, Diagnostics& diagnostics);

/// Returns a channel of a declaration with {name} replaced by the argument or its default.  Empty: the argument has no
/// value.
std::string channel_of(const ProgramDeclaration& declaration, const ConfigNode& args, const std::string& pattern);

/// Returns the value of an argument, or its default, as text; empty when it has none.
std::string text_of_arg(const ProgramDeclaration& declaration, const ConfigNode& args, const std::string& name);

}  // namespace sim
