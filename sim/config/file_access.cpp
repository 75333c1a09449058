// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/file_access.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace sim {
namespace {

namespace fs = std::filesystem;

/// Returns the absolute path with all symbolic links resolved as far as it exists; empty when that fails.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path.empty() ? "." : path, error);
  if (error) return {};
  fs::path canonical = fs::weakly_canonical(whole, error);
  if (error) return {};
  if (!canonical.has_filename()) canonical = canonical.parent_path();  // `folder/`
  return canonical;
}

std::vector<fs::path> all_resolved(const std::vector<std::string>& paths) {
  std::vector<fs::path> result;
  for (const std::string& path : paths)
    if (fs::path whole = resolved(path); !whole.empty()) result.push_back(std::move(whole));
  return result;
}

bool is_below(const fs::path& path, const fs::path& folder) {
  const auto [end_of_folder, at] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end_of_folder == folder.end();
}

bool is_below_any(const fs::path& path, const std::vector<fs::path>& folders) {
  return !path.empty() &&
         std::any_of(folders.begin(), folders.end(), [&](const fs::path& folder) { return is_below(path, folder); });
}

}  // namespace

FileAccess::FileAccess(std::vector<std::string> folders, std::vector<std::string> allowed,
                       std::set<std::string> known_keys)
    : folders_(all_resolved(folders)), allowed_(all_resolved(allowed)), known_keys_(std::move(known_keys)) {}

bool FileAccess::may_read(const std::string& path) const {
  const fs::path whole = resolved(path);
  return is_below_any(whole, folders_) || is_below_any(whole, allowed_);
}

bool FileAccess::may_make(const std::string& path) const {
  const fs::path given(path);
  if (ignores_ports_) return true;
  if (given.is_relative()) return std::none_of(given.begin(), given.end(), [](const fs::path& p) { return p == ".."; });
  return is_below_any(resolved(given), allowed_);
}

bool FileAccess::may_quote(const std::string& path) const {
  return is_below_any(resolved(path), allowed_);
}

std::string FileAccess::allowed_above(const std::string& path) const {
  const fs::path whole = resolved(path);
  for (const fs::path& folder : allowed_)
    if (!whole.empty() && is_below(whole, folder)) return folder.string();
  return {};
}

std::string FileAccess::reading_rule() {
  return "must lie below the folder of the world, the folder 'vehicles' beside that or the shipped ones, or below a "
         "folder given with --allow-path";
}

std::string FileAccess::making_rule() {
  return "must be relative to the folder of the run, without '..', or lie below a folder given with --allow-path";
}

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
