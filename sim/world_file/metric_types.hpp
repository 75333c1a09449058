// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace sim {

/// The words of all types of metrics, as in `type: position_error`.
std::vector<std::string> metric_type_words();

}  // namespace sim
