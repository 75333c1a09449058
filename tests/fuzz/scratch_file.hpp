// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fuzz/fuzz_target.hpp"

namespace fuzz {

/// A folder of this process, for parsers that look at the names of files or beside them.  It lies below TMPDIR, which
/// tools/fuzz clears: a program that libFuzzer ends leaves it behind.
inline const std::filesystem::path& scratch_folder() {
  static const struct Folder {
    Folder() {
      std::string name = (std::filesystem::temp_directory_path() / "shoal-fuzz-XXXXXX").string();
      path = mkdtemp(name.data());
    }
    ~Folder() {
      std::error_code error;
      std::filesystem::remove_all(path, error);
    }
    std::filesystem::path path;
  } folder;
  return folder.path;
}

/// Writes a file there and gives its path.
inline std::string write_scratch(const std::string& name, Input content) {
  const std::string path = (scratch_folder() / name).string();
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
  return path;
}

}  // namespace fuzz
