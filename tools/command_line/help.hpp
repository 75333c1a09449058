// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <utility>
#include <vector>

namespace command_line {

/// Last sections of the help of a command.
struct HelpEnd {
  std::vector<std::string> examples;                    ///< whole commands; `#` starts a remark
  std::vector<std::pair<int, std::string>> exit_codes;  ///< code and meaning
  std::vector<std::string> notes;                       ///< paragraphs
};

void set_help_end(CLI::App& command, const HelpEnd& end);

/// Returns the help of a command, laid out in lines of `columns` characters.
std::string help_text(const CLI::App& command, std::size_t columns);

/// Returns the name of an option or argument: `--duration`, `WORLD`.
std::string option_name(const CLI::Option& option);

/// Returns the placeholder of an option's value in help and errors: `FILE`.
std::string value_name(const CLI::Option& option);

}  // namespace command_line
