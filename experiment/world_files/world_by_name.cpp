// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/world_files/world_by_name.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "sim/config/config_node.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;

constexpr const char* ending = ".yaml";

struct Words {
  const char* folder;
  const char* one;
  const char* list;
};

Words words_of(ShippedKind kind) {
  switch (kind) {
    case ShippedKind::world:
      return {"worlds", "world", "worlds"};
    case ShippedKind::vehicle:
      return {"vehicles", "vehicle", "vehicles"};
    case ShippedKind::study:
      break;
  }
  return {"worlds/studies", "study", "studies"};
}

/// Adds the names and paths of the files in a folder.
void add_files(const fs::path& folder, const std::string& prefix, std::vector<ShippedFile>& files) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ending && entry.is_regular_file(error))
      files.push_back({prefix + entry.path().stem().string(), entry.path().string(), ""});
}

/// Returns names and paths only, without reading the files.
std::vector<ShippedFile> named_files(ShippedKind kind) {
  std::vector<ShippedFile> files;
  const std::string shipped = sim::shipped_folder();
  if (shipped.empty()) return files;
  const fs::path folder = fs::path(shipped) / words_of(kind).folder;
  add_files(folder, "", files);
  if (kind == ShippedKind::world) add_files(folder / "benchmark", "benchmark/", files);
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return files;
}

/// Advice for a name without a file of the right kind.
std::string advice(const std::string& name, const std::string& meant, const std::string& lists) {
  for (const ShippedKind kind : {ShippedKind::world, ShippedKind::vehicle, ShippedKind::study})
    for (const ShippedFile& file : named_files(kind))
      if (file.name == name) return "'" + name + "' is a shipped " + words_of(kind).one;
  return meant.empty() ? "see " + lists : "did you mean '" + meant + "'?";
}

[[noreturn]] void refuse_name(std::initializer_list<ShippedKind> kinds, const std::string& given) {
  std::string what, lists;
  std::vector<std::string> names;
  for (const ShippedKind kind : kinds) {
    const Words words = words_of(kind);
    what += (what.empty() ? "" : " or ") + std::string(words.one);
    lists += (lists.empty() ? "`shoal list " : " and `shoal list ") + std::string(words.list) + "`";
    for (const ShippedFile& file : named_files(kind)) names.push_back(file.name);
  }
  const std::string name = sim::shortened(sim::printable(given));
  const std::string stem = fs::path(given).stem().string();
  // The ending is added only to a name without one.
  const std::string file = fs::path(given).has_extension() ? "" : ", nor '" + name + ending + "'";
  sim::throw_config_error({}, "'" + name + "'",
                          "there is no such file here" + file + ", nor a shipped " + what + " of this name; " +
                              advice(stem, sim::closest_name(stem, names), lists));
}

/// A shipped file by its path in the sources, such as `worlds/coop_land.yaml`, or by a name with a folder.
std::optional<std::string> shipped_path(std::initializer_list<ShippedKind> kinds, const std::string& given) {
  for (const ShippedKind kind : kinds)
    for (const ShippedFile& file : named_files(kind))
      if (given == std::string(words_of(kind).folder) + "/" + file.name + ending || given == file.name)
        return file.path;
  return std::nullopt;
}

}  // namespace

std::vector<ShippedFile> shipped_files(ShippedKind kind) {
  std::vector<ShippedFile> files = named_files(kind);
  for (ShippedFile& file : files) {
    sim::Diagnostics ignored;  // `shoal check` reports the errors of a file
    const sim::ConfigNode root = sim::load_config_file(file.path, ignored);
    if (const sim::ConfigNode* description = root.find("description")) file.description = description->scalar;
  }
  return files;
}

std::string file_by_name(std::initializer_list<ShippedKind> kinds, const std::string& given) {
  std::error_code error;
  const fs::path path(given);
  const bool bare =
      !given.empty() && given.find('/') == std::string::npos && (!path.has_extension() || path.extension() == ending);
  if (fs::is_regular_file(given, error)) return given;
  if (!bare) return shipped_path(kinds, given).value_or(given);
  // A folder may have the name of a world: that of its results.
  const bool is_folder = fs::is_directory(given, error);
  if (!is_folder && fs::exists(given, error)) return given;  // such as a pipe, which its reader reports
  if (fs::is_regular_file(given + ending, error)) return given + ending;
  for (const ShippedKind kind : kinds)
    for (const ShippedFile& file : named_files(kind))
      if (file.name == path.stem()) return file.path;
  if (is_folder) return given;
  refuse_name(kinds, given);
}

}  // namespace experiment
