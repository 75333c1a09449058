// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace tools {

/// A library of commands is missing, and could not be built.
struct LibraryError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Loads lib/shoal/NAME.so beside the folder of the program.  What it registers is there when this returns.  Of a build
/// folder it is built first, if it is missing or older than the program.  Throws LibraryError.
void load_library(const std::string& name);

}  // namespace tools
