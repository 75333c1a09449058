// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tools {

/// Loads lib/shoal/NAME.so beside the folder of the program.  What it registers is there when this returns.  Of a build
/// folder it is built first, if it is missing or older than the program.  Throws std::runtime_error when it is missing
/// and cannot be built.
void load_library(const std::string& name);

}  // namespace tools
