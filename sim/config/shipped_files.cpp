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

std::string shipped_folder_of(const std::string& folder) {
  const fs::path above = fs::path(folder).parent_path();
  for (const fs::path& shipped : {above / "share/shoal", source_of_build(above)})
    if (!shipped.empty() && has_worlds(shipped)) return shipped.lexically_normal().string();
  return {};
}

/// Returns the file of this program; in a library that another program has loaded, that of the library.
static fs::path own_file() {
  Dl_info info{};
  std::error_code error;
  if (dladdr(reinterpret_cast<const void*>(&shipped_folder), &info) != 0 && info.dli_fname != nullptr) {
    fs::path file = fs::canonical(info.dli_fname, error);
    if (!error && file.extension() == ".so") return file;
  }
  fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program;
}

std::string shipped_folder() {
  static const std::string folder = [] {
    const fs::path own = own_file();
    if (own.extension() != ".so") return shipped_folder_of(own.parent_path().string());
    // The library may be at any depth below the prefix
    for (fs::path at = own.parent_path(); at.has_relative_path(); at = at.parent_path())
      if (std::string found = shipped_folder_of(at.string()); !found.empty()) return found;
    return std::string();
  }();
  return folder;
}

std::string program_folder() {
  static const std::string folder = [] {
    const fs::path own = own_file();
    if (own.extension() != ".so") return own.parent_path().string();
    std::error_code error;
    for (fs::path at = own.parent_path(); at.has_relative_path(); at = at.parent_path())
      if (fs::exists(at / "bin/shoal", error)) return (at / "bin").string();
    return std::string();
  }();
  return folder;
}

}  // namespace sim
