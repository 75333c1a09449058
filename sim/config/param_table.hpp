// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace sim {

/// Returns key, type, rule, default and meaning of each key; nested keys are named by their paths as below.
std::vector<std::array<std::string, 5>> param_rows(const std::vector<ParamInfo>& params);

/// Returns the keys as a Markdown table: key, type, rule, default, meaning.  Keys of a map are written as
/// `noise.gaussian_std`, keys of the items of a list as `parts[].shape`.
std::string markdown_table(const std::vector<ParamInfo>& params);

/// Returns the same table as text in columns, for a terminal.
std::string text_table(const std::vector<ParamInfo>& params);

}  // namespace sim
