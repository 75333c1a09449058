// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/robot_folders.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "sim/config/message_text.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

fs::path folder_of(const std::string& file) {
  const fs::path parent = fs::path(file).parent_path();
  return parent.empty() ? "." : parent;
}

}  // namespace

RobotFolders::RobotFolders(const std::string& file, const FolderOptions& options) : options_(options) {
  allow(folder_of(file));
  for (const auto& [name, folder] : options_.packages) allow(folder);
  for (const std::string& folder : options_.models) allow(folder);
}

void RobotFolders::allow(const fs::path& folder) {
  std::error_code error;
  const fs::path resolved = fs::canonical(folder, error);
  if (!error) allowed_.push_back(resolved);
}

std::string RobotFolders::find(const std::string& uri, const std::string& what, const sim::SourcePlace& place) const {
  const fs::path path = named(uri, what, place);
  std::error_code error;
  const fs::path resolved = fs::weakly_canonical(path, error);
  const bool allowed = !error && std::any_of(allowed_.begin(), allowed_.end(),
                                             [&](const fs::path& folder) { return is_below(resolved, folder); });
  if (!allowed)
    sim::throw_config_error(place, "",
                            what + " must be below the folder of the file or a folder of --package NAME=DIR");
  return resolved.string();
}

fs::path RobotFolders::named(const std::string& uri, const std::string& what, const sim::SourcePlace& place) const {
  const fs::path own = folder_of(*place.file);
  if (uri.starts_with("http://") || uri.starts_with("https://"))
    sim::throw_config_error(place, "", what + " is a web address: nothing is downloaded");
  for (const std::string scheme : {"package://", "model://"}) {
    if (!uri.starts_with(scheme)) continue;
    const std::size_t slash = uri.find('/', scheme.size());
    const std::string name = uri.substr(scheme.size(), slash - scheme.size());
    return folder_named(name, scheme == "model://", own, place) /
           (slash == std::string::npos ? "" : uri.substr(slash + 1));
  }
  const std::string file_scheme = "file://";
  const fs::path path = uri.starts_with(file_scheme) ? uri.substr(file_scheme.size()) : uri;
  std::error_code error;
  // Gazebo also looks for a plain name in the folders of models.
  if (!fs::exists(own / path, error) && path.is_relative())
    for (const std::string& folder : options_.models)
      if (fs::exists(fs::path(folder) / path, error)) return fs::path(folder) / path;
  return own / path;  // an absolute path replaces the folder
}

fs::path RobotFolders::folder_named(const std::string& name, bool is_model, const fs::path& own,
                                    const sim::SourcePlace& place) const {
  const auto package = options_.packages.find(name);
  if (package != options_.packages.end()) return package->second;
  std::error_code error;
  for (const std::string& folder : options_.models)
    if (is_model && !name.empty() && fs::is_directory(fs::path(folder) / name, error)) return fs::path(folder) / name;
  // A model names its own files like this, too.
  if (is_model && fs::weakly_canonical(own, error).filename() == name) return own;
  sim::throw_config_error(
      place, "",
      fmt::format("the folder of {0} '{1}' is unknown: give --package {1}=DIR{2}", is_model ? "model" : "package",
                  sim::printable(name), is_model ? ", or --models with the folder that contains it" : ""));
}

}  // namespace tools
