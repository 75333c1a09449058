// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

namespace tools {

/// The number that a key of a file reads from the text: decimal, with an optional sign, finite.  Nothing when the text
/// is none.
std::optional<double> number_of(std::string_view text);

inline bool is_zero(std::string_view text) {
  const auto number = number_of(text);
  return number && *number == 0;
}

}  // namespace tools
