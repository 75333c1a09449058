// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <system_error>

#include "sim/config/config_node.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"

namespace sim {
namespace {

namespace fs = std::filesystem;
using Kind = ConfigNode::Kind;

constexpr std::size_t max_bytes = 64'000'000;
constexpr int max_files = 100;

bool is_list_of_named_maps(const ConfigNode& node) {
  return node.kind == Kind::list && !node.items.empty() &&
         std::all_of(node.items.begin(), node.items.end(),
                     [](const ConfigNode& item) { return name_of(item) != nullptr; });
}

void merge(ConfigNode& base, ConfigNode&& over);

void merge_maps(ConfigNode& base, ConfigNode&& over) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < base.entries.size(); ++i) index.emplace(base.entries[i].key, i);
  for (ConfigNode::Entry& entry : over.entries) {
    const auto found = index.find(entry.key);
    if (found == index.end()) {
      base.entries.push_back(std::move(entry));
      continue;
    }
    ConfigNode::Entry& target = base.entries[found->second];
    // The place is that of the overriding file, where the user finds what is in force.
    target.place = entry.place;
    merge(target.value, std::move(entry.value));
  }
  base.place = over.place;
}

void merge_lists_by_name(ConfigNode& base, ConfigNode&& over) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < base.items.size(); ++i) index.emplace(*name_of(base.items[i]), i);
  for (ConfigNode& item : over.items) {
    const auto found = index.find(*name_of(item));
    if (found == index.end()) {
      base.items.push_back(std::move(item));
      continue;
    }
    merge(base.items[found->second], std::move(item));
    // A second item of this name is a duplicate that the reader must detect, not another layer.
    index.erase(found);
  }
  base.place = over.place;
}

/// Merges `over` into `base`.  Values keep their places.
void merge(ConfigNode& base, ConfigNode&& over) {
  if (base.kind == Kind::map && over.kind == Kind::map)
    merge_maps(base, std::move(over));
  else if (is_list_of_named_maps(base) && is_list_of_named_maps(over))
    merge_lists_by_name(base, std::move(over));
  else
    base = std::move(over);
}

/// Returns the path of an included file: beside the file that includes it, else the shipped world or vehicle of this
/// name.
fs::path included_path(const fs::path& by, const fs::path& name) {
  const fs::path beside = by.parent_path() / name;
  std::error_code error;
  if (fs::exists(beside, error) || name.has_parent_path() || shipped_folder().empty()) return beside;
  for (const char* kind : {"worlds", "vehicles"})
    if (const fs::path shipped = fs::path(shipped_folder()) / kind / name; fs::is_regular_file(shipped, error))
      return shipped;
  return beside;
}

void forward(const Diagnostics& from, Diagnostics& to) {
  for (const std::string& line : from.lines()) to.error({}, "", line);
}

/// Reads a file and its included files.
class Loader {
 public:
  Loader(Diagnostics& diagnostics, Origin named_by) : diagnostics_(diagnostics), named_by_(named_by) {}

  /// `asked_at`: place of the include; a place without a line for the first file.
  ConfigNode load(const fs::path& path, const SourcePlace& asked_at) {
    const SourcePlace whole_file{intern_file_name(path.string()), 0, 0};
    if (++files_ > max_files) return fail(asked_at, "more than " + std::to_string(max_files) + " files included");
    std::error_code error;
    // Refuse cycles and files that are not allowed.
    fs::path canonical = fs::weakly_canonical(path, error);
    if (error) canonical = path;
    if (std::find(open_.begin(), open_.end(), canonical) != open_.end())
      return fail(asked_at, "'" + shortened(path.string()) + "' includes itself");
    const auto& access = diagnostics_.files();
    if (access != nullptr && !open_.empty() && !access->may_read(path))
      return fail(asked_at, "'" + shortened(path.string()) + "' " + FileAccess::reading_rule());
    // Read and parse the file.
    const std::optional<std::string> text = read_text(path, asked_at);
    if (!text) return {};
    Diagnostics own;  // separate, because a repeated error adds no line to diagnostics_
    if (hides(path)) own.hide_files();
    ConfigNode node = parse_file_text(*text, path.string(), own);
    if (own.ok() && node.kind != Kind::null) check_top_level(node, path, own);
    forward(own, diagnostics_);
    if (!own.ok()) return {};
    if (node.kind == Kind::null) return fail(whole_file, "the file is empty");
    // Merge the included files.
    open_.push_back(canonical);
    node = with_includes(std::move(node), path);
    open_.pop_back();
    return node;
  }

 private:
  /// Returns whether only a world names the file, which may then be any file, and the command line does not.
  bool hides(const fs::path& path) const {
    const auto& access = diagnostics_.files();
    return access != nullptr && (named_by_ != Origin::command_line || !open_.empty()) && !access->may_quote(path);
  }

  void check_top_level(const ConfigNode& node, const fs::path& path, Diagnostics& own) const {
    const bool hidden = hides(path);
    if (node.kind != Kind::map) {
      const std::string rule =
          !hidden && !open_.empty() ? "an included file must be a map of keys" : "must be a map of keys and values";
      return own.error(node.place, "", hidden ? rule : rule + ", got " + shown(node));
    }
    if (!hidden) return;
    // The errors below may quote the file: it must be a file of Shoal, not a private file of the user.
    for (const ConfigNode::Entry& entry : node.entries)
      if (!diagnostics_.files()->is_known_key(entry.key))
        own.error(entry.place, "", "unknown key of a world or vehicle file");
  }

  ConfigNode fail(const SourcePlace& place, const std::string& text) {
    diagnostics_.error(place, "", text);
    return {};
  }

  std::optional<std::string> read_text(const fs::path& path, const SourcePlace& asked_at) {
    const std::string subject = asked_at.line > 0 ? "'" + shortened(path.string()) + "'" : "the file";
    std::error_code status_error;
    if (fs::is_directory(path, status_error)) {
      fail(asked_at, "cannot read " + subject + ": it is a directory");
      return std::nullopt;
    }
    // Refuse special files: a pipe without a writer would block, and so would a terminal.
    if (fs::exists(path, status_error) && !fs::is_regular_file(path, status_error)) {
      fail(asked_at, "cannot read " + subject + ": it is not a regular file" +
                         (asked_at.line > 0 ? "" : "; 'shoal run --special-files' allows that"));
      return std::nullopt;
    }
    // Read the file up to the limit of all files.
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    std::string text;
    char block[1 << 16];
    while (stream && text.size() + total_bytes_ <= max_bytes) {
      stream.read(block, sizeof block);
      text.append(block, static_cast<std::size_t>(stream.gcount()));
    }
    if (!stream.is_open() || stream.bad()) {
      fail(asked_at, "cannot read " + subject + ": " + std::generic_category().message(errno));
      return std::nullopt;
    }
    total_bytes_ += text.size();
    if (total_bytes_ > max_bytes) {
      fail(asked_at, subject + (files_ > 1 ? " and the files before it are" : " is") + " larger than 64 MB");
      return std::nullopt;
    }
    return text;
  }

  ConfigNode with_includes(ConfigNode node, const fs::path& path) {
    const auto is_include = [](const ConfigNode::Entry& entry) { return entry.key == "include"; };
    const auto found = std::find_if(node.entries.begin(), node.entries.end(), is_include);
    if (found == node.entries.end()) return node;
    const ConfigNode include = std::move(found->value);
    // The key must not reach the reader, which would report it as unknown.
    node.entries.erase(found);
    ConfigNode base;
    for (const ConfigNode* name : included_names(include)) {
      ConfigNode layer = load(included_path(path, name->scalar), name->place);
      if (layer.kind == Kind::map) merge(base, std::move(layer));
    }
    merge(base, std::move(node));
    return base;
  }

  std::vector<const ConfigNode*> included_names(const ConfigNode& include) {
    std::vector<const ConfigNode*> names;
    if (include.kind == Kind::scalar) names.push_back(&include);
    for (const ConfigNode& item : include.items) names.push_back(&item);
    const auto is_name = [](const ConfigNode* name) { return name->kind == Kind::scalar && !name->scalar.empty(); };
    if (include.kind == Kind::map || include.kind == Kind::null || !std::all_of(names.begin(), names.end(), is_name)) {
      fail(include.place, "'include' must be a file name or a list of file names, got " + shown(include));
      return {};
    }
    return names;
  }

  Diagnostics& diagnostics_;
  Origin named_by_;
  std::vector<fs::path> open_;
  std::size_t total_bytes_ = 0;
  int files_ = 0;
};

}  // namespace

ConfigNode load_config_file(const std::string& path, Diagnostics& diagnostics, Origin named_by) {
  Diagnostics own(diagnostics.files());
  ConfigNode root = Loader(own, named_by).load(path, {intern_file_name(path), 0, 0});
  forward(own, diagnostics);
  return own.ok() ? root : ConfigNode{};
}

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
