// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/file_kind.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "sim/config/config_node.hpp"

namespace sim {

namespace {

constexpr std::size_t max_kind_bytes = std::size_t{1} << 20;

const char* name_of(FileKind kind) {
  switch (kind) {
    case FileKind::world:
      return "a world";
    case FileKind::vehicle:
      return "a vehicle";
    case FileKind::study:
      return "a study";
    case FileKind::motion:
      return "a motion";
    case FileKind::declaration:
      break;
  }
  return "a declaration of a program";
}

const char* advice_for(FileKind kind) {
  switch (kind) {
    case FileKind::world:
      return "`shoal run FILE` runs it";
    case FileKind::vehicle:
      return "name it as `file:` of a vehicle in a world; `shoal check FILE` checks it";
    case FileKind::study:
      return "`shoal study FILE` runs it";
    case FileKind::motion:
      return "name it as `file:` in `motions` of a motion_player; `shoal check FILE` checks it";
    case FileKind::declaration:
      break;
  }
  return "`shoal check FILE` checks it";
}

/// `a world, not a vehicle`; empty: it is of this kind, or no key decides.
std::string other_kind_text(const ConfigNode& root, FileKind expected) {
  const FileKind kind = kind_of_file(root);
  // A study without its keys is a study with missing keys.
  const bool is_evident = kind != FileKind::world || root.find("vehicles") != nullptr;
  if (kind == expected || !is_evident) return {};
  return std::string(name_of(kind)) + ", not " + name_of(expected);
}

}  // namespace

FileKind kind_of_file(const ConfigNode& root) {
  const auto has = [&](const char* key) { return root.find(key) != nullptr; };
  if (has("shoal_args")) return FileKind::declaration;
  if (has("study") || (has("cases") && has("world"))) return FileKind::study;
  if (has("motion") || (has("keys") && has("poses"))) return FileKind::motion;
  if (has("vehicle") || (has("bodies") && !has("vehicles"))) return FileKind::vehicle;
  return FileKind::world;
}

void require_file_kind(const ConfigNode& root, FileKind expected, const SourcePlace& file) {
  const std::string text = other_kind_text(root, expected);
  if (!text.empty()) throw_config_error(file, "", "this is " + text + "; " + advice_for(kind_of_file(root)));
}

std::string other_kind(const std::string& path, FileKind expected) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  std::ifstream in(path, std::ios::binary);
  const auto bytes = std::min<std::uintmax_t>(std::filesystem::file_size(path, error), max_kind_bytes);
  std::string text(error ? 0 : static_cast<std::size_t>(bytes), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  Diagnostics ignored;
  return other_kind_text(parse_file_text(text, path, ignored), expected);
}

}  // namespace sim
