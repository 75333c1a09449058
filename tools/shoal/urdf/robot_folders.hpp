// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sim/config/diagnostics.hpp"

namespace tools {

/// Folders that a robot's files may be in.
struct FolderOptions {
  std::map<std::string, std::string> packages;  ///< of ROS packages and models by name, for package:// and model://
  std::vector<std::string> models;              ///< with a folder for each model, for model://NAME
};

/// Finds the files that a URDF or SDF names, in its own folder and in those that the user named, and nowhere else.
class RobotFolders {
 public:
  /// `file`: the file that is imported.
  RobotFolders(const std::string& file, const FolderOptions& options);

  /// Path of a file or folder that another file names, with symbolic links resolved.  `what` is for errors, such as
  /// `mesh 'body.stl'`; relative paths start at the folder of the file in which `place` is.  Throws sim::ConfigError
  /// for a path that is elsewhere, and for a web address: nothing is downloaded.
  std::string find(const std::string& uri, const std::string& what, const sim::SourcePlace& place) const;

 private:
  void allow(const std::filesystem::path& folder);
  std::filesystem::path named(const std::string& uri, const std::string& what, const sim::SourcePlace& place) const;
  std::filesystem::path folder_named(const std::string& name, bool is_model, const std::filesystem::path& own,
                                     const sim::SourcePlace& place) const;

  FolderOptions options_;
  std::vector<std::filesystem::path> allowed_;
};

}  // namespace tools
