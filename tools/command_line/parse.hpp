// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

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

}  // namespace command_line
