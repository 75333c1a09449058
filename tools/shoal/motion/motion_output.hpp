// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "sim/motion/motion.hpp"

namespace tools {

/// Adds `--overwrite`.
void add_overwrite_option(CLI::App& command, bool& overwrite);

/// Throws command_line::UsageError when a file exists and may not be overwritten, std::runtime_error when it cannot be
/// written.  Before the work that gives its content.
void check_new_file(const std::string& path, bool overwrite);

/// Throws command_line::UsageError when write_motion() would replace a CSV file that does not belong to the motion
/// file.
void check_frames(const std::string& path, const sim::JointMotion& motion, bool overwrite);
/// The same for a motion that is not known yet, and that may have frames.
void check_frames(const std::string& path, bool overwrite);

}  // namespace tools
