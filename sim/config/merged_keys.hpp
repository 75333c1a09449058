// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/config/param_info.hpp"

namespace sim {

/// Merges the keys of several types into one table, each key once and none required.  `types`: word and keys of each
/// type.  The description of a key that belongs to one or two types names them, unless the key has the name of the
/// type.
std::vector<ParamInfo> merged_keys(const std::vector<std::pair<std::string, std::vector<ParamInfo>>>& types);

}  // namespace sim
