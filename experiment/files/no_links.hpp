// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bridges/base/file_descriptor.hpp"

namespace experiment {

/// Checks of paths below a folder that someone else may have made: a symbolic link there would let this program write
/// or remove files elsewhere.  The folder itself may be a link, because the user has named it.

/// Throws std::runtime_error when `path`, or a folder between `root` and it, is a symbolic link.  `path` starts with
/// `root`; what does not exist is not one.
void refuse_links(const std::string& root, const std::string& path);

/// Creates the folder `root` and those below it on the way to `folder`, without following links below `root`.  Throws
/// std::runtime_error when one is a link or cannot be made.
void make_folders(const std::string& root, const std::string& folder);

/// Makes a new, empty file for reading and writing, in place of a file or link of this name: what a link there leads to
/// is not touched.  Also for files that another program or library then opens by this name.  Throws std::system_error
/// with the reason alone.
bridges::FileDescriptor make_new_file(const std::string& path);

}  // namespace experiment
