// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace tools {

/// Adds `shoal bug`, like the functions of commands.hpp.
void add_bug_command(CLI::App& app, int& exit_code);

}  // namespace tools
