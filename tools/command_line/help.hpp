// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace command_line {

/// What stands at the end of a command's help.
struct HelpEnd {
  std::vector<std::string> examples;                    ///< whole commands; `#` begins a remark
  std::vector<std::pair<int, std::string>> exit_codes;  ///< what each means
  std::vector<std::string> notes;                       ///< paragraphs
};

void set_help_end(CLI::App& command, const HelpEnd& end);

/// The help of a command for lines of `columns` characters.
std::string help_text(const CLI::App& command, std::size_t columns);

/// `--duration`, `WORLD`.
std::string option_name(const CLI::Option& option);

/// What stands for the value of an option in help and errors: `FILE`.
std::string value_name(const CLI::Option& option);

}  // namespace command_line
