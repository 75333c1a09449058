// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace experiment {

/// Replaces `before`, the content of the file, by `after`.  The new file is written beside the old one, with its owner
/// and permissions, flushed to the disk, and renamed.  A symbolic link is kept; its target is replaced. Throws
/// sim::ConfigError with the path and the reason, without any change, when the content differs from `before`, the file
/// has further hard links (which would keep the old text), or it cannot be written.
void replace_file(const std::string& path, const std::string& before, const std::string& after);

/// Writes a file as a whole: it is complete under its name, or as it was before.  An existing file keeps its owner and
/// permissions, a symbolic link is kept and its target replaced.  Throws std::runtime_error with the path and the
/// reason, such as for a name of a device, a pipe or a folder.
void write_whole_file(const std::string& path, const std::string& text);

/// Throws std::runtime_error when write_whole_file() would fail now; for errors before a long work.  Changes nothing.
void check_whole_file(const std::string& path);

}  // namespace experiment
