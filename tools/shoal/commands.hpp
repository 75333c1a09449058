// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>

#include "sim/world_file/load_world.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/help.hpp"

namespace tools {

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

/// Adds `--plugin FILE`; the plugin is loaded before the command runs.
void add_plugin_option(CLI::App& command);

/// Adds `--log-level LEVEL`, the level of messages on stderr, except for the error that ends the command.  To be called
/// first, so that it applies to all other options.
CLI::Option* add_log_level_option(CLI::App& command, const std::string& usual = "info");

/// Adds `--set PATH=VALUE`.
void add_set_option(CLI::App& command, std::vector<std::string>& sets);

/// Adds `--allow-path PATH`.  From then on a world may name only files of its own folders, and these.
void add_allow_path_option(CLI::App& command, sim::LoadOptions& load);

/// Adds `--lcm-url URL`.
CLI::Option* add_lcm_url_option(CLI::App& command, std::string& url);

/// Adds `--threads N`, the number of worker threads for ray casting.
void add_threads_option(CLI::App& command, int& threads);

/// Adds `--types FILE`: message types that are not part of Shoal.
void add_types_option(CLI::App& command, std::vector<std::string>& lcm_files);

/// Each function adds a sub-command.  When chosen, the command sets `exit_code`.
void add_run_command(CLI::App& app, int& exit_code);
void add_view_command(CLI::App& app, int& exit_code);
void add_replay_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_snap_command(CLI::App& app, int& exit_code);
void add_film_command(CLI::App& app, int& exit_code);
void add_describe_command(CLI::App& app, int& exit_code);
void add_list_command(CLI::App& app, int& exit_code);
void add_snapshot_command(CLI::App& app, int& exit_code);
void add_spy_command(CLI::App& app, int& exit_code);
void add_control_command(CLI::App& app, int& exit_code);
void add_drive_command(CLI::App& app, int& exit_code);
void add_doctor_command(CLI::App& app, int& exit_code);
void add_log_command(CLI::App& app, int& exit_code);
void add_log_mcap_command(CLI::App& app, int& exit_code);
void add_acoustics_command(CLI::App& app, int& exit_code);
void add_bench_command(CLI::App& app, int& exit_code);
void add_mesh_command(CLI::App& app, int& exit_code);
void add_medium_command(CLI::App& app, int& exit_code);
void add_fidelity_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_study_command(CLI::App& app, int& exit_code);
void add_upgrade_command(CLI::App& app, int& exit_code);

}  // namespace tools
