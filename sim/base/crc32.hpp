// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace sim {

/// CRC-32 of IEEE 802.3, computed by zlib; the same as Python's binascii.crc32 and java.util.zip.CRC32.
inline std::uint32_t crc32(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace sim
