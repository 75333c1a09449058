// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "sim/config/config_node.hpp"

namespace sim {

/// Returns the tree as YAML on one line, such as `{name: left, axis: [0, 1, 0]}`.  Stops soon after `limit` bytes.
std::string to_flow_yaml(const ConfigNode& node, std::size_t limit = static_cast<std::size_t>(-1));

}  // namespace sim
