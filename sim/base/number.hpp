// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace sim {

// Numbers and their text, with a decimal point in every locale.  The locale of the process is not ours: a Python
// program may have set one with a comma, which printf, std::to_string(double) and strtod follow.

/// Reads all of a text as a number of this type, without blanks or '+'.  nullopt for other text and for a number that
/// the type cannot hold.
template <class Number>
std::optional<Number> exact_number(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && at == end ? std::optional(value) : std::nullopt;
}

/// Reads all of a text as a decimal number.  One too small for a double is 0, one too large is infinite.
/// nullopt for other text.
inline std::optional<double> read_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  double value = 0;
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::invalid_argument || at != end) return std::nullopt;
  if (error == std::errc{}) return value;
  // Out of range at either end, which the greater range of long double tells apart; beyond it, the exponent does.
  long double wide = 0;
  if (std::from_chars(text.data(), end, wide).ec == std::errc{}) return static_cast<double>(wide);
  const bool is_small = text.find("e-") != text.npos || text.find("E-") != text.npos;
  return is_small ? 0 : (text.starts_with('-') ? -1 : 1) * std::numeric_limits<double>::infinity();
}

/// Returns the shortest text that reads as the same number.
inline std::string shortest_text(double value) {
  char text[40];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

/// Returns whether a number has only nines, such as 9999, -99.9 or 99.999: in many files a code for a missing value.
inline bool is_nines(double value) {
  const std::string text = shortest_text(value);
  return text.find_first_not_of("-.9") == text.npos && text.find('9') != text.npos;
}

/// Rounds a number to significant digits, at most 17.
inline double rounded_to(double value, int digits) {
  char text[40];
  const char* const end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr;
  return read_number({text, static_cast<std::size_t>(end - text)}).value_or(value);
}

}  // namespace sim
