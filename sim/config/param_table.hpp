// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace sim {

/// Key, type, rule, default, meaning of each key, those of maps and lists by their paths as below.
std::vector<std::array<std::string, 5>> param_rows(const std::vector<ParamInfo>& params);

/// The keys as a table in Markdown: key, type, rule, default, meaning.  The keys of a map are
/// `noise.gaussian_std`, those of the items of a list `parts[].shape`.
std::string markdown_table(const std::vector<ParamInfo>& params);

/// The same as text in columns, for a terminal.
std::string text_table(const std::vector<ParamInfo>& params);

}  // namespace sim
