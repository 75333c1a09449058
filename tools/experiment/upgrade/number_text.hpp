// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

namespace tools {

/// Parses a number as a key of a file does: decimal, with an optional sign, finite.  Returns nothing for any other
/// text.
std::optional<double> number_of(std::string_view text);

inline bool is_zero(std::string_view text) {
  const auto number = number_of(text);
  return number && *number == 0;
}

}  // namespace tools
