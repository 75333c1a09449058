// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace command_line {

/// Adds `--plugin FILE`; the plugin is loaded before the command runs.
void add_plugin_option(CLI::App& command);

/// Loads the plugin that `--plugin` names.  Throws sim::ConfigError.
void load_plugin(const std::string& file);

}  // namespace command_line
