// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/upgrade/upgrade_text.hpp"

namespace tools {

/// What is to become of a file.
struct FileUpgrade {
  enum class State {
    up_to_date,
    changes,  ///< `upgraded` is what it is to be
    refused   ///< `error` says why; it is left as it is
  };

  std::string path;
  State state = State::up_to_date;
  std::string before;  ///< the text that was read
  UpgradedText upgraded;
  std::vector<std::string> errors;
};

/// Reads world, vehicle and study files and those that they include, each once, in the order in which they are named.
/// Writes nothing.
std::vector<FileUpgrade> plan_upgrade(const std::vector<std::string>& paths);

/// Puts the new text of a file in the place of the old one, which is there until the new one is whole.  The file keeps
/// its permissions, a symbolic link stays.  Throws sim::ConfigError with the path and the reason; the file is then as
/// it was.
void write_upgrade(const FileUpgrade& file);

}  // namespace tools
