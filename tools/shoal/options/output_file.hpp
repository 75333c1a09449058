// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace tools {

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
