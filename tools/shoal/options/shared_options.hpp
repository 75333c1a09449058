// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <CLI/App.hpp>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "experiment/run/run_page.hpp"
#include "sim/world_file/load_world.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/command_line/declared_options.hpp"
#include "tools/command_line/help.hpp"

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

/// Parses the value of --speed: `max` (0) or a multiple of real time; std::nullopt if it is empty.  Throws
/// CLI::ValidationError.
std::optional<double> parse_speed(const std::string& text);

/// Adds the options of the live page, except the one that opens it.
void add_page_options(CLI::App& command, experiment::ViewOptions& view);
/// Adds `--open`: whether the address of the page is shown in the browser.
CLI::Option* add_open_option(CLI::App& command, bool& open);

/// Throws std::runtime_error when a file cannot be written, so that the error occurs before the work.  Creates nothing.
inline void check_writable(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) throw std::runtime_error(path + ": cannot be written: no such folder");
  if (fs::is_directory(path, error)) throw std::runtime_error(path + ": cannot be written: it is a folder");
  if (access(fs::exists(path, error) ? path.c_str() : folder.c_str(), W_OK) != 0)
    throw std::runtime_error(path + ": cannot be written: not allowed");
}

}  // namespace tools
