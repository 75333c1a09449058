#pragma once

#include <CLI/CLI.hpp>

namespace tools {

/// Exit codes of the shoal program.
enum ExitCode {
  exit_ok = 0,
  exit_failed = 1,      ///< the experiment's own rule
  exit_usage = 2,       ///< command line or configuration
  exit_physics = 3,
  exit_bus = 4,         ///< bus or file trouble
  exit_timeout = 5
};

/// Each adds its sub-command.  When chosen, the command sets `exit_code`.
void add_run_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_describe_command(CLI::App& app, int& exit_code);
void add_list_command(CLI::App& app, int& exit_code);
void add_spy_command(CLI::App& app, int& exit_code);
void add_doctor_command(CLI::App& app, int& exit_code);
void add_log_command(CLI::App& app, int& exit_code);
void add_bench_command(CLI::App& app, int& exit_code);

}  // namespace tools
