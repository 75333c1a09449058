// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/config/config_node.hpp"

namespace tools {

/// Writes DIRECTORY/world.yaml.  A run does so before its first step: one that is killed leaves it, too.  Throws
/// std::runtime_error.
void write_results_world(const std::string& directory, const sim::ConfigNode& resolved);

}  // namespace tools
