// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/upgrade/upgrade_text.hpp"

namespace tools {

/// Planned upgrade of a file.
struct FileUpgrade {
  enum class State {
    up_to_date,
    changes,  ///< `upgraded` is the new text
    refused   ///< `errors` gives the reasons; the file is not changed
  };

  std::string path;
  State state = State::up_to_date;
  std::string before;  ///< the text that was read
  UpgradedText upgraded;
  std::vector<std::string> errors;
};

/// Plans the upgrade of world, vehicle and study files and those that they include, each once, in the order in which
/// they are named.  Writes nothing.
std::vector<FileUpgrade> plan_upgrade(const std::vector<std::string>& paths);

/// Replaces the text of a file atomically: the old text stays until the new one is complete.  The file keeps its
/// permissions, and a symbolic link is kept.  Throws sim::ConfigError with the path and the reason; the file is then
/// unchanged.
void write_upgrade(const FileUpgrade& file);

}  // namespace tools
