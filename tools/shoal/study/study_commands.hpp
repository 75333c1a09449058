// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/shoal/options/shared_options.hpp"

namespace tools {

/// Adds `shoal study` with its sub-commands.
void add_study_command(CLI::App& app, int& exit_code);
/// Adds `shoal tune`.
void add_tune_command(CLI::App& app, int& exit_code);

}  // namespace tools
