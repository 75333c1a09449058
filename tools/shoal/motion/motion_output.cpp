// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/motion_output.hpp"

#include <filesystem>

#include "tools/experiment/motion/motion_file.hpp"
#include "tools/shoal/options/output_file.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

void refuse(const std::string& frames, const std::string& path, bool overwrite) {
  if (overwrite || frames.empty()) return;
  throw command_line::UsageError("'" + frames + "' exists and does not belong to '" + path +
                                 "'; --overwrite replaces it");
}

}  // namespace

void add_overwrite_option(CLI::App& command, bool& overwrite) {
  command.add_flag("--overwrite", overwrite, "replace existing files");
}

void check_new_file(const std::string& path, bool overwrite) {
  std::error_code error;
  if (!overwrite && std::filesystem::exists(path, error))
    throw command_line::UsageError("'" + path + "' exists; --overwrite replaces it");
  check_writable(path);
}

void check_frames(const std::string& path, const sim::JointMotion& motion, bool overwrite) {
  refuse(foreign_frames(path, motion), path, overwrite);
}

void check_frames(const std::string& path, bool overwrite) {
  refuse(foreign_frames(path), path, overwrite);
}

}  // namespace tools
