// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/parsed_files.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <mutex>
#include <optional>

namespace sim {

namespace {

constexpr std::size_t max_kept_bytes = 100'000;

/// Trees of files without errors, the oldest of which is replaced.
class ParsedFiles {
 public:
  std::optional<ConfigNode> find(const std::string& text, const std::string& path) {
    const std::lock_guard lock(mutex_);
    for (const File& file : files_)
      if (file.path == path && file.text == text) return file.tree;
    return {};
  }
  void keep(const std::string& text, const std::string& path, const ConfigNode& tree) {
    const std::lock_guard lock(mutex_);
    const auto known = std::find_if(files_.begin(), files_.end(), [&](const File& file) { return file.path == path; });
    File& replaced = known != files_.end() ? *known : files_[next_++ % files_.size()];
    replaced = {path, text, tree};
  }

 private:
  struct File {
    std::string path, text;
    ConfigNode tree;
  };
  std::mutex mutex_;
  std::array<File, 32> files_;
  std::size_t next_ = 0;
};

ParsedFiles& parsed_files() {
  static ParsedFiles* const all = new ParsedFiles;  // until the end of the process
  return *all;
}

}  // namespace

ConfigNode parse_file_text(const std::string& text, const std::string& path, Diagnostics& diagnostics) {
  if (text.size() > max_kept_bytes) return parse_config_text(text, path, diagnostics);
  if (auto tree = parsed_files().find(text, path)) return std::move(*tree);
  Diagnostics own;
  ConfigNode tree = parse_config_text(text, path, own);
  if (own.ok()) {
    parsed_files().keep(text, path, tree);
    return tree;
  }
  return parse_config_text(text, path, diagnostics);  // its errors as the caller wants them
}

}  // namespace sim
