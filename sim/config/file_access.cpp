// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/file_access.hpp"

#include <algorithm>

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

}  // namespace sim
