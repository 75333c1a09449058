// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace command_line {

/// Exit code of wrong usage, as of a wrong world file.
inline constexpr int exit_usage = 2;

/// Parses the command line of `app`, whose name is that of the program, and runs the command that it names.  Help is
/// printed on stdout; wrong usage on stderr in one line, followed by the command that prints the help.  Returns the
/// exit code in these cases; nothing when the command ran.  What the command throws passes through, apart from
/// CLI::ParseError, which is wrong usage.
std::optional<int> parse(CLI::App& app, int argc, const char* const* argv);

/// Prints what is wrong with the use of a command such as `shoal run`, and gives the exit code.
int wrong_usage(const std::string& command, const std::string& what);

}  // namespace command_line
