// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "sim/motion/motion.hpp"

namespace tools {

/// Adds `--overwrite`.
void add_overwrite_option(CLI::App& command, bool& overwrite);

/// Throws command_line::UsageError when a motion file exists and may not be overwritten, or has the name of a CSV file,
/// std::runtime_error when it cannot be written.  Before the work that gives its content.
void check_new_file(const std::string& path, bool overwrite);

/// Throws command_line::UsageError when write_motion() would replace a CSV file that does not belong to the motion
/// file.
void check_frames(const std::string& path, const sim::JointMotion& motion, bool overwrite);
/// The same for a motion that is not known yet, and that may have frames.
void check_frames(const std::string& path, bool overwrite);

/// Returns what a command was asked for, in its words: `scale --by 2`, without its files.
std::string operation_of(const CLI::App& command);

/// Returns what a motion has: `9.000 s, 12 joints, 34 keys`.
std::string content_text(const sim::JointMotion& motion);

}  // namespace tools
