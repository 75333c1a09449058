// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <spdlog/fmt/fmt.h>

#include <CLI/App.hpp>

#include "sim/world_file/load_world.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/help.hpp"
#include "tools/command_line/plugin_option.hpp"

namespace tools {

using command_line::add_plugin_option;
using command_line::number_from;
using command_line::one_of;
using command_line::whole_from;

/// Exit codes of the shoal program.
enum ExitCode {
  exit_ok = 0,
  exit_failed = 1,  ///< a rule of the experiment
  exit_usage = 2,   ///< command line or configuration
  exit_physics = 3,
  exit_bus = 4,  ///< bus or file error
  exit_timeout = 5
};

/// Adds `--log-level LEVEL`, the level of messages on stderr, except for the error that ends the command.  To be called
/// first, so that it applies to all other options.
CLI::Option* add_log_level_option(CLI::App& command, const std::string& usual = "info");

/// Adds `--set PATH=VALUE`.
void add_set_option(CLI::App& command, std::vector<std::string>& sets);

/// Adds `--allow-path PATH`.  From then on a world may name only files of its own folders, and these.
void add_allow_path_option(CLI::App& command, sim::LoadOptions& load);

/// Adds `--lcm-url URL`.
CLI::Option* add_lcm_url_option(CLI::App& command, std::string& url);

/// Adds `--threads N`, the number of threads that share the work of a step.
void add_threads_option(CLI::App& command, int& threads);

/// Adds `--types FILE`: message types that are not part of Shoal.
void add_types_option(CLI::App& command, std::vector<std::string>& lcm_files);

}  // namespace tools
