#pragma once

#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>

namespace tools {

/// Exit codes of the shoal program.
enum ExitCode {
  exit_ok = 0,
  exit_failed = 1,  ///< the experiment's own rule
  exit_usage = 2,   ///< command line or configuration
  exit_physics = 3,
  exit_bus = 4,  ///< bus or file trouble
  exit_timeout = 5
};

/// Refuses what is no number, or none in this range: CLI::Range and its kin let nan and inf pass.
inline CLI::Validator number_from(double low, double high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    double number = 0;
    if (CLI::detail::lexical_cast(text, number) && number >= low && number <= high) return "";
    return fmt::format("must be from {:g} to {:g}, got '{}'", low, high, text);
  };
  return CLI::Validator(check, fmt::format("FLOAT in [{:g} - {:g}]", low, high));
}

/// Adds `--plugin FILE`, which is loaded before the command does anything.
void add_plugin_option(CLI::App& command);

/// Each adds its sub-command.  When chosen, the command sets `exit_code`.
void add_run_command(CLI::App& app, int& exit_code);
void add_replay_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_snap_command(CLI::App& app, int& exit_code);
void add_describe_command(CLI::App& app, int& exit_code);
void add_list_command(CLI::App& app, int& exit_code);
void add_snapshot_command(CLI::App& app, int& exit_code);
void add_spy_command(CLI::App& app, int& exit_code);
void add_control_command(CLI::App& app, int& exit_code);
void add_doctor_command(CLI::App& app, int& exit_code);
void add_log_command(CLI::App& app, int& exit_code);
void add_acoustics_command(CLI::App& app, int& exit_code);
void add_bench_command(CLI::App& app, int& exit_code);
void add_mesh_command(CLI::App& app, int& exit_code);
void add_medium_command(CLI::App& app, int& exit_code);
void add_fidelity_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_study_command(CLI::App& app, int& exit_code);

}  // namespace tools
