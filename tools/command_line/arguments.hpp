// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace command_line {

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
