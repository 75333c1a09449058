// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace test_support {

/// Absolute path of a file of the project, such as "worlds/coop_land.yaml"; of its folder for "".
std::string source_path(const std::string& path);
/// Absolute path in the folder that the project is built in, such as "bin/shoal"; of that folder for "".
std::string built_path(const std::string& path);

}  // namespace test_support
