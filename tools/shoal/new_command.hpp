// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace tools {

/// Adds `shoal new`, which writes starter files.  When chosen, it sets `exit_code`.
void add_new_command(CLI::App& app, int& exit_code);

}  // namespace tools
