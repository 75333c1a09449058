// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

namespace command_line {

/// Exit code of wrong usage; the same as that of an invalid world file.
inline constexpr int exit_usage = 2;

/// Parses the command line of `app`, whose name is that of the program, and runs the named command.  Prints help on
/// stdout; prints wrong usage on stderr in one line, followed by the command that prints the help.  Returns the exit
/// code in these cases; std::nullopt if the command ran.  Exceptions of the command are passed on, except
/// CLI::ParseError, which is wrong usage.
std::optional<int> parse(CLI::App& app, int argc, const char* const* argv);

/// Prints the usage error of a command such as `shoal run`, and returns the exit code.
int wrong_usage(const std::string& command, const std::string& what);

/// Arguments of a command line, classified before CLI11 parses them, because the errors of CLI11 name its own types.
struct Arguments {
  CLI::App* command = nullptr;         ///< the innermost command that was named
  bool help = false;                   ///< --help, -h, or `help COMMAND`
  std::vector<std::string> for_cli11;  ///< arguments for CLI11, in an unambiguous form, the last one first
  std::string wrong;                   ///< the error; empty: none
};

/// Classifies `arguments`, which exclude the name of the program, by the commands and options of `app`.
Arguments read_arguments(CLI::App& app, const std::vector<std::string>& arguments);

/// Returns the names of the command and its parents: `shoal log info`.
std::string command_path(const CLI::App& command);

/// Returns the commands of an app, in the order in which they were added.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

}  // namespace command_line
