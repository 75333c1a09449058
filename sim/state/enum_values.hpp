// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace sim::detail {

/// Returns whether an enumeration has a name for this value: compilers write an unnamed value as a cast such as
/// `(Kind)5`.
template <auto value>
constexpr bool has_name() {
  const std::string_view function = __PRETTY_FUNCTION__;
  const std::string_view text = function.substr(function.rfind("value = "));
  const std::size_t cast = text.rfind(')');  // of a cast, or of an unnamed namespace
  return cast == std::string_view::npos || text[cast + 1] == ':';
}

/// Returns a mask with one bit for each of the values 0 to 31 that has a name.
template <typename Enum, std::size_t... values>
constexpr std::uint32_t named_values(std::index_sequence<values...>) {
  return ((has_name<static_cast<Enum>(values)>() ? std::uint32_t{1} << values : 0u) | ...);
}

/// Returns whether the value is an enumerator of its type.  The enumerators of the type must be from 0 to 31.
template <typename Enum>
constexpr bool is_enumerator(Enum value) {
  constexpr std::uint32_t named = named_values<Enum>(std::make_index_sequence<32>());
  static_assert(named != 0 && !has_name<static_cast<Enum>(32)>(), "enumerators must be from 0 to 31");
  const auto number = static_cast<std::uint64_t>(value);
  return number < 32 && (named >> number & 1) != 0;
}

}  // namespace sim::detail
