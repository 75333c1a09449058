// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace experiment {

/// Temporary directory for files that another program reads; it is removed with its content.
class ScratchDirectory {
 public:
  /// Throws std::runtime_error.
  ScratchDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "shoal_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot create a directory at " + name);
    path = name;
  }
  ~ScratchDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;

  std::filesystem::path path;
};

}  // namespace experiment
