// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/shipped_files.hpp"

#include <filesystem>
#include <fstream>

namespace sim {

namespace {

namespace fs = std::filesystem;

bool has_worlds(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "worlds", error) && fs::is_directory(folder / "vehicles", error);
}

/// Returns the source folder recorded by CMake in a build folder; empty when it is not a build folder.
fs::path source_of_build(const fs::path& build) {
  constexpr std::string_view mark = "CMAKE_HOME_DIRECTORY:INTERNAL=";
  std::ifstream cache(build / "CMakeCache.txt");
  for (std::string line; std::getline(cache, line);)
    if (line.starts_with(mark)) return line.substr(mark.size());
  return {};
}

}  // namespace

std::string shipped_folder_of(const std::string& program_folder) {
  const fs::path above = fs::path(program_folder).parent_path();
  for (const fs::path& folder : {above / "share/shoal", source_of_build(above)})
    if (!folder.empty() && has_worlds(folder)) return folder.lexically_normal().string();
  return {};
}

std::string shipped_folder() {
  static const std::string folder = [] {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    return error ? std::string() : shipped_folder_of(program.parent_path().string());
  }();
  return folder;
}

}  // namespace sim
