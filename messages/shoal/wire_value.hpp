// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "shoal/message_schema.hpp"

namespace shoal {

// Values in the encoding of LCM.  The caller makes sure that their bytes are there.

/// Returns an unsigned number, whose bytes are big-endian.
template <class T>
T big_endian(const std::byte* at) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value << 8 | std::to_integer<T>(at[i]));
  return value;
}

/// Returns a value of an integer type, or of type byte or boolean.
inline std::int64_t read_integer(WireType type, const std::byte* at) {
  switch (wire_size(type)) {
    case 1:
      return type == WireType::int8 ? static_cast<std::int8_t>(*at) : std::to_integer<std::int64_t>(*at);
    case 2:
      return static_cast<std::int16_t>(big_endian<std::uint16_t>(at));
    case 4:
      return static_cast<std::int32_t>(big_endian<std::uint32_t>(at));
    default:
      return static_cast<std::int64_t>(big_endian<std::uint64_t>(at));
  }
}

/// Returns a value of type float32 or float64.
inline double read_real(WireType type, const std::byte* at) {
  return type == WireType::float32 ? std::bit_cast<float>(big_endian<std::uint32_t>(at))
                                   : std::bit_cast<double>(big_endian<std::uint64_t>(at));
}

}  // namespace shoal
