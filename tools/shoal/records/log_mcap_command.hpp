// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>

namespace tools {

/// Adds `shoal log mcap`.
void add_log_mcap_command(CLI::App& log, int& exit_code);

}  // namespace tools
