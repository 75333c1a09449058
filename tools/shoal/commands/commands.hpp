// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "tools/shoal/options/shared_options.hpp"

namespace tools {

/// Adds options and action to the command of that name, which `app` has; when chosen, the command sets `exit_code`.
using AddCommand = void (*)(CLI::App& app, int& exit_code);

/// Groups of commands in the help.
enum class CommandGroup { run, look, measure, make, connect };

/// Registers the function of a command: before main, or when its library is loaded.  Returns true.
bool register_command(AddCommand add);
/// Registers a command, in its own file NAME_command.cpp.  Group, name and description are known before its library is
/// loaded: cmake/CommandTable.cmake reads them from the file.
#define SHOAL_COMMAND(group, name, description, add) \
  [[maybe_unused]] static const bool add##_is_registered = ::tools::register_command(add)

/// Adds the names and descriptions of all commands to the command line.
void list_commands(CLI::App& app);

/// Makes a command complete, with its options and action; loads its library.  Throws std::runtime_error.
void complete_command(CLI::App& app, int& exit_code, const std::string& name);

/// Does so for all commands.
void complete_commands(CLI::App& app, int& exit_code);

/// Returns the path of a program shoal-NAME, beside this program or in PATH; empty when there is none, or when a
/// command has this name.
std::string outside_command(const std::string& name);

/// Returns what to call in place of a command of other programs, such as `play`; empty: nothing is known.
std::string meant_call(const std::string& name);

/// Loads lib/shoal/NAME.so beside the folder of the program.  What it registers is there when this returns.  Of a build
/// folder it is built first, if it is missing or older than the program.  Throws std::runtime_error when it is missing
/// and cannot be built.
void load_library(const std::string& name);

}  // namespace tools
