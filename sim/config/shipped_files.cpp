// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/shipped_files.hpp"

#include <dlfcn.h>

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

/// Returns the library that contains this function; the program when it is not in a library.
static fs::path library_of_this() {
  Dl_info info{};
  std::error_code error;
  if (dladdr(reinterpret_cast<const void*>(&shipped_folder), &info) == 0 || info.dli_fname == nullptr) return {};
  return fs::canonical(info.dli_fname, error);
}

std::string shipped_folder() {
  static const std::string folder = [] {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (std::string found = error ? "" : shipped_folder_of(program.parent_path().string()); !found.empty())
      return found;
    // In a library that another program has loaded, such as the module of Python, at any depth below its prefix.
    for (fs::path at = library_of_this().parent_path(); at.has_relative_path(); at = at.parent_path())
      if (std::string found = shipped_folder_of(at.string()); !found.empty()) return found;
    return std::string();
  }();
  return folder;
}

}  // namespace sim
