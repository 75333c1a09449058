// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tools {

/// Puts `after` in the place of `before`, what the file holds.  The new file is written beside the old one, with its
/// owner and permissions, brought to the disk, and renamed.  A symbolic link stays; what it leads to is replaced.
/// Throws sim::ConfigError with the path and the reason, and leaves the file as it was, when it holds something else by
/// now, has further hard links (which would keep the old text), or cannot be written.
void replace_file(const std::string& path, const std::string& before, const std::string& after);

}  // namespace tools
