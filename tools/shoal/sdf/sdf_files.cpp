// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/sdf/sdf_files.hpp"

#include <filesystem>

#include "sim/config/message_text.hpp"

namespace tools {

namespace fs = std::filesystem;

const XmlFile& SdfFiles::open(const std::string& path) {
  const auto known = files_.find(path);
  return known != files_.end() ? known->second : add(path, read_robot_file(path));
}

const XmlFile& SdfFiles::add(const std::string& path, const std::string& text) {
  bytes_ += text.size();
  if (bytes_ > 4 * max_robot_file_bytes) refuse_file(path, "is one too many: all files have more than 64 MiB");
  return files_.try_emplace(path, text, path, "sdf").first->second;
}

std::string SdfFiles::find_model(const XmlElement& uri) const {
  const std::string what = "model '" + sim::shortened(sim::printable(uri.content()), 200) + "'";
  if (uri.content().empty()) uri.refuse("<uri> must not be empty");
  const std::string found = folders_.find(uri.content(), what, uri.place());
  std::error_code error;
  if (!fs::is_directory(found, error)) {
    if (!fs::exists(found, error)) uri.refuse(what + " does not exist");
    return found;
  }
  const std::string config = (fs::path(found) / "model.config").string();
  if (!fs::is_regular_file(config, error)) return (fs::path(found) / "model.sdf").string();
  const XmlFile manifest(read_robot_file(config), config, "model");
  std::string name = "model.sdf";
  double newest = 0;
  const std::vector<XmlElement> files = manifest.root().children("sdf");
  for (const XmlElement& file : files) {
    const double version = file.optional_number("version").value_or(1);
    if (version < newest) continue;
    newest = version;
    name = folders_.find(file.content(), what, file.place());
  }
  return (fs::path(found) / name).string();
}

}  // namespace tools
