// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace command_line {

/// Adds an option of names, comma separated; it may be repeated.  An empty name is an error: CLI11 would drop it, and
/// take an option with empty names only for one that was not given.
CLI::Option* add_name_list(CLI::App& command, const std::string& option, std::vector<std::string>& names,
                           const std::string& meaning);

}  // namespace command_line
