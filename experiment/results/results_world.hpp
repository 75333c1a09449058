// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/config/config_node.hpp"

namespace experiment {

/// Writes DIRECTORY/world.yaml.  A run does so before its first step, so that the file exists even when the run is
/// killed. Throws std::runtime_error.
void write_results_world(const std::string& directory, const sim::ConfigNode& resolved);

}  // namespace experiment
