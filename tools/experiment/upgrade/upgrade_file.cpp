// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/upgrade_file.hpp"

#include <algorithm>
#include <cerrno>
#include <deque>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <system_error>

#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"
#include "tools/experiment/files/file_replacement.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;
using NodeKind = sim::ConfigNode::Kind;

constexpr std::size_t max_bytes = 64'000'000;
constexpr std::size_t max_files = 1000;

/// File to be upgraded, and the place that refers to it.
struct QueuedFile {
  std::string path;
  sim::SourcePlace referenced_at;
  std::optional<FileKind> kind;  ///< kind of the file that includes it
};

/// Reads a regular file of at most 64 MB.
std::optional<std::string> read_text(const QueuedFile& file, sim::Diagnostics& diagnostics) {
  const bool is_included = file.referenced_at.line > 0;
  const std::string subject = is_included ? "'" + sim::shortened(file.path) + "'" : "the file";
  const auto fail = [&](const std::string& why) {
    diagnostics.error(file.referenced_at, "", "cannot read " + subject + ": " + why);
    return std::nullopt;
  };
  // Check the kind of file.
  std::error_code error;
  const fs::file_status status = fs::status(file.path, error);
  if (fs::is_directory(status)) return fail("it is a directory");
  if (fs::exists(status) && !fs::is_regular_file(status)) return fail("it is not a regular file");
  // Read up to the limit.
  errno = 0;
  std::ifstream stream(file.path, std::ios::binary);
  std::string text;
  char block[1 << 16];
  while (stream && text.size() <= max_bytes) {
    stream.read(block, sizeof block);
    text.append(block, static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.is_open() || stream.bad()) return fail(std::generic_category().message(errno));
  if (text.size() > max_bytes) return fail("it is larger than 64 MB");
  return text;
}

std::vector<std::string> folders_of(const std::vector<std::string>& paths) {
  std::vector<std::string> folders;
  for (const std::string& path : paths) folders.push_back(fs::path(path).parent_path().string());
  return folders;
}

/// Plans one file after the other.
class Planner {
 public:
  explicit Planner(const std::vector<std::string>& paths) : access_(folders_of(paths), paths, {}) {
    for (const std::string& path : paths) queue_.push_back({path, {sim::intern_file_name(path), 0, 0}, std::nullopt});
  }

  std::vector<FileUpgrade> plan() {
    std::vector<FileUpgrade> files;
    for (; !queue_.empty(); queue_.pop_front()) {
      std::error_code error;
      const fs::path canonical = fs::weakly_canonical(queue_.front().path, error);
      if (!seen_.insert(error ? fs::path(queue_.front().path) : canonical).second) continue;
      files.push_back(plan_file(queue_.front()));
    }
    return files;
  }

 private:
  FileUpgrade plan_file(const QueuedFile& queued) {
    FileUpgrade file;
    file.path = queued.path;
    sim::Diagnostics diagnostics;
    if (const auto text = read_text(queued, diagnostics)) {
      file.before = *text;
      plan_text(file, queued, diagnostics);
    }
    if (!diagnostics.ok()) file.state = FileUpgrade::State::refused;
    file.errors = diagnostics.lines();
    return file;
  }

  void plan_text(FileUpgrade& file, const QueuedFile& queued, sim::Diagnostics& diagnostics) {
    const sim::ConfigNode root = sim::parse_config_text(file.before, file.path, diagnostics);
    if (!diagnostics.ok()) return;
    const sim::SourcePlace whole_file{sim::intern_file_name(file.path), 0, 0};
    if (root.kind == NodeKind::null) return diagnostics.error(whole_file, "", "the file is empty");
    if (root.kind != NodeKind::map)
      return diagnostics.error(root.place, "", "must be a map of keys and values, got " + sim::shown(root));
    const std::optional<FileKind> kind = queued.kind ? queued.kind : kind_of(root);
    if (!kind) return diagnostics.error(whole_file, "", "must be a world, a vehicle or a study");
    want_included(root, file.path, *kind, diagnostics);
    auto upgraded = upgrade_text(file.before, *kind, file.path, diagnostics);
    if (!upgraded) return;
    file.upgraded = std::move(*upgraded);
    if (!file.upgraded.lines.empty()) file.state = FileUpgrade::State::changes;
  }

  void want_included(const sim::ConfigNode& root, const std::string& path, FileKind kind,
                     sim::Diagnostics& diagnostics) {
    const sim::ConfigNode* include = root.find("include");
    if (include == nullptr) return;
    std::vector<const sim::ConfigNode*> names;
    if (include->kind == NodeKind::scalar) names.push_back(include);
    for (const sim::ConfigNode& item : include->items) names.push_back(&item);
    for (const sim::ConfigNode* name : names) {
      if (name->kind != NodeKind::scalar || name->scalar.empty()) continue;  // `shoal check` reports the error
      if (seen_.size() + queue_.size() > max_files)
        return diagnostics.error(name->place, "", "more than " + std::to_string(max_files) + " files");
      const std::string included = (fs::path(path).parent_path() / name->scalar).string();
      // A file may be untrusted: it must not select files elsewhere to be rewritten, read or quoted.
      if (!access_.may_read(included))
        return diagnostics.error(
            name->place, "",
            "'" + sim::shortened(sim::printable(name->scalar)) +
                "' must lie below the folder of a file on the command line, or be one of these files");
      queue_.push_back({included, name->place, kind});
    }
  }

  sim::FileAccess access_;  ///< permits the included files to be rewritten
  std::deque<QueuedFile> queue_;
  std::set<fs::path> seen_;
};

}  // namespace

std::vector<FileUpgrade> plan_upgrade(const std::vector<std::string>& paths) {
  return Planner(paths).plan();
}

void write_upgrade(const FileUpgrade& file) {
  replace_file(file.path, file.before, file.upgraded.text);
}

}  // namespace tools
