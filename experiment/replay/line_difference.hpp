// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace experiment {

/// Returns the lines that differ between two texts, in order: `-` before lines only in the first, `+` before lines only
/// in the second, with the line number.  At most `max` lines, followed by the number of the remaining ones.
std::vector<std::string> line_difference(const std::string& first, const std::string& second, std::size_t max = 40);

}  // namespace experiment
