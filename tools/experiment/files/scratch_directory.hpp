// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace tools {

/// A directory for files that another program reads; it goes away with all that is in it.
class ScratchDirectory {
 public:
  /// Throws std::runtime_error.
  ScratchDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "shoal_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no directory can be made at " + name);
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

}  // namespace tools
