// SPDX-License-Identifier: BSD-3-Clause
// The one file that is compiled again in every checkout: no other holds a path of it.
#include "tests/project_paths.hpp"

namespace test_support {

std::string source_path(const std::string& path) {
  return path.empty() ? SHOAL_SOURCE_DIR : SHOAL_SOURCE_DIR "/" + path;
}

std::string built_path(const std::string& path) {
  return path.empty() ? SHOAL_BINARY_DIR : SHOAL_BINARY_DIR "/" + path;
}

}  // namespace test_support
