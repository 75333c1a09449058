// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/file_kind.hpp"

namespace sim {

namespace {

const char* name_of(FileKind kind) {
  switch (kind) {
    case FileKind::world:
      return "a world";
    case FileKind::vehicle:
      return "a vehicle";
    case FileKind::study:
      return "a study";
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
    case FileKind::declaration:
      break;
  }
  return "`shoal check FILE` checks it";
}

}  // namespace

FileKind kind_of_file(const ConfigNode& root) {
  const auto has = [&](const char* key) { return root.find(key) != nullptr; };
  if (has("shoal_args")) return FileKind::declaration;
  if (has("study") || (has("cases") && has("world"))) return FileKind::study;
  if (has("vehicle") || (has("bodies") && !has("vehicles"))) return FileKind::vehicle;
  return FileKind::world;
}

void require_file_kind(const ConfigNode& root, FileKind expected, const SourcePlace& file) {
  const FileKind kind = kind_of_file(root);
  // A study without its keys is a study with missing keys.
  const bool is_evident = kind != FileKind::world || root.find("vehicles") != nullptr;
  if (kind == expected || !is_evident) return;
  throw_config_error(file, "",
                     std::string("this is ") + name_of(kind) + ", not " + name_of(expected) + "; " + advice_for(kind));
}

}  // namespace sim
