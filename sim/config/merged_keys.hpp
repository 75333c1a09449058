// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/config/param_info.hpp"

namespace sim {

/// The keys of several types in one table, each once and none required.  `types`: word and keys of each.  The
/// description of a key of one or two types names them, unless the key has the name of the type.
std::vector<ParamInfo> merged_keys(const std::vector<std::pair<std::string, std::vector<ParamInfo>>>& types);

}  // namespace sim
