// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tools {

/// The lines that differ between two texts, in order: `-` before those of the first alone, `+` before those of the
/// second alone, with the number of the line.  At most `most`, then how many more.
std::vector<std::string> line_difference(const std::string& first, const std::string& second, std::size_t max = 40);

}  // namespace tools
