// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace experiment {

/// Reads the key `seeds`: numbers, ranges such as 1-10, or a map of first and count.
std::vector<std::int64_t> read_seeds(sim::ParamReader& in);

/// Parses the seeds of a command line: `7`, `1-10` or `1-3,8`.  Throws std::invalid_argument with the rule.
std::vector<std::int64_t> parse_seeds(const std::string& text);

}  // namespace experiment
