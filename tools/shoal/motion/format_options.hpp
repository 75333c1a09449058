// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "motion/formats/joint_names.hpp"
#include "motion/formats/motion_format.hpp"

namespace tools {

/// Arguments of an export and of an import.
struct FormatArguments {
  std::string input, output, format, vehicle, names;
  double loop_step_ms = 0, row_ms = 20;
  bool keep_names = false, strict = false, overwrite = false;
  motion::FormatOptions options;
};

/// Adds the arguments that both commands have.
void add_format_options(CLI::App& command, FormatArguments& arguments);

/// Returns the names of joints for --vehicle, else for the vehicle that a motion names; reports when there is no file.
motion::JointNames names_for(const FormatArguments& arguments, const std::string& vehicle_of_motion);

/// Throws when the output exists and may not be overwritten, or cannot be written.
void check_output(const FormatArguments& arguments, const std::string& path);

/// Prints what is lost to stderr; returns whether the command continues: not with --strict and a loss.
bool may_lose(const FormatArguments& arguments, const motion::Losses& losses);

/// Returns a sentence with the formats that an import or an export has, for the help.
std::string formats_text(bool is_import);

/// Writes a file.  Throws std::runtime_error.
void write_bytes(const std::string& path, const std::string& bytes);

/// Returns the names of the joint servos of a vehicle file, with the lists of `names_file`; empty: of
/// joint_names/NAME.yaml beside the vehicle file or among the shipped ones, where it exists.  Throws sim::ConfigError.
motion::JointNames joint_names_of(const std::string& vehicle_file, const std::string& names_file);

/// Returns the file of the vehicle that a motion names: NAME.yaml beside the motion or among the shipped ones; empty:
/// there is none.
std::string vehicle_file_of(const std::string& vehicle, const std::string& motion_file);

}  // namespace tools
