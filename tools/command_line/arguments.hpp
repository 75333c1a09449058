// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace command_line {

/// Classifies the words of a command line before CLI11 reads them, as its errors refer to its own types.
struct Arguments {
  CLI::App* command = nullptr;         ///< the innermost command that was named
  bool help = false;                   ///< --help, -h, or `help COMMAND`
  std::vector<std::string> for_cli11;  ///< in a form that it cannot misread, the last argument first
  std::string wrong;                   ///< the error; empty: none
};

/// Reads the arguments, without the name of the program, for the commands and options of `app`.
Arguments read_arguments(CLI::App& app, const std::vector<std::string>& arguments);

/// `shoal log info`.
std::string command_path(const CLI::App& command);

/// The commands of an app, in the order in which they were added.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

}  // namespace command_line
