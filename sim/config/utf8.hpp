// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sim {

/// Returns the number of bytes of the UTF-8 character at `at`; 0 when it is invalid (RFC 3629: no overlong forms, no
/// surrogates).
std::size_t utf8_length(std::string_view text, std::size_t at = 0);

/// Returns the text without the byte order mark that spreadsheets and other programs write before it.
inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

/// Returns the text with bytes that are not UTF-8 written as `\xe9`.
std::string in_utf8(std::string_view text);

}  // namespace sim
