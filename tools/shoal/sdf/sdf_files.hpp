// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "tools/shoal/urdf/robot_folders.hpp"
#include "tools/shoal/urdf/xml_file.hpp"

namespace tools {

/// The SDF files of an import: the one that the user named, and those that it includes from the folders of the import.
class SdfFiles {
 public:
  SdfFiles(const std::string& path, const FolderOptions& options) : folders_(path, options) {}

  /// Parses a file once.  Throws sim::ConfigError; all files together may have 64 MiB.
  const XmlFile& open(const std::string& path);
  /// Adds a file by its text.
  const XmlFile& add(const std::string& path, const std::string& text);
  /// Path of the file that a `<uri>` names: of a folder, the newest one that its `model.config` names, or else
  /// `model.sdf`.  Throws sim::ConfigError.
  std::string find_model(const XmlElement& uri) const;

 private:
  RobotFolders folders_;
  std::map<std::string, XmlFile> files_;
  std::size_t bytes_ = 0;
};

}  // namespace tools
