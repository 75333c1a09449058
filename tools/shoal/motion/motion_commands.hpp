// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/motion/motion.hpp"
#include "sim/world_file/vehicle_config.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

constexpr double mm = 1000;  ///< in a meter

/// Each function adds a sub-command of `shoal motion`.
void add_motion_show_command(CLI::App& motion, int& exit_code);
void add_motion_check_command(CLI::App& motion, int& exit_code);
void add_motion_edit_command(CLI::App& motion, int& exit_code);
void add_motion_play_command(CLI::App& motion, int& exit_code);
void add_motion_record_command(CLI::App& motion, int& exit_code);
void add_motion_compare_command(CLI::App& motion, int& exit_code);
void add_motion_stability_command(CLI::App& motion, int& exit_code);
void add_motion_evolve_command(CLI::App& motion, int& exit_code);
void add_motion_divergence_command(CLI::App& motion, int& exit_code);
void add_motion_connect_command(CLI::App& motion, int& exit_code);
void add_motion_export_command(CLI::App& motion, int& exit_code);
void add_motion_import_command(CLI::App& motion, int& exit_code);

/// Adds `--world WORLD` and `--vehicle NAME`: where a motion is played.
void add_stage_options(CLI::App& command, std::string& world, std::string& vehicle);

/// Reads a motion file.  Throws sim::ConfigError.
sim::JointMotion motion_of(const std::string& path);

/// Reads the vehicle for a motion: the named file, else the shipped one that the motion names.  Throws ConfigError,
/// command_line::UsageError when neither is known.
sim::VehicleConfig vehicle_of(const std::string& file, const sim::JointMotion& motion);

}  // namespace tools
