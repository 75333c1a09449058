#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace sim {

namespace crc32_detail {

/// Row 0: one byte at a time; row k: a byte with k zero bytes behind it.
constexpr std::array<std::array<std::uint32_t, 256>, 8> make_tables() {
  std::array<std::array<std::uint32_t, 256>, 8> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder >> 1) ^ ((remainder & 1) != 0 ? 0xEDB88320u : 0u);
    tables[0][byte] = remainder;
  }
  for (std::size_t row = 1; row < 8; ++row)
    for (std::size_t byte = 0; byte < 256; ++byte)
      tables[row][byte] = (tables[row - 1][byte] >> 8) ^ tables[0][tables[row - 1][byte] & 0xFF];
  return tables;
}

inline constexpr auto tables = make_tables();

}  // namespace crc32_detail

/// CRC-32 of IEEE 802.3, the one of zlib, Python's binascii.crc32 and java.util.zip.CRC32.
inline std::uint32_t crc32(std::span<const std::byte> bytes) {
  const auto& t = crc32_detail::tables;
  std::uint32_t remainder = 0xFFFFFFFFu;
  const std::byte* at = bytes.data();
  std::size_t left = bytes.size();
  const auto byte_at = [&](std::size_t i) { return std::to_integer<std::uint32_t>(at[i]); };
  // Eight bytes at once: each goes through the row that puts it behind the others.
  for (; left >= 8; at += 8, left -= 8) {
    const std::uint32_t low = remainder ^ (byte_at(0) | byte_at(1) << 8 | byte_at(2) << 16 | byte_at(3) << 24);
    remainder = t[7][low & 0xFF] ^ t[6][low >> 8 & 0xFF] ^ t[5][low >> 16 & 0xFF] ^ t[4][low >> 24] ^ t[3][byte_at(4)] ^
                t[2][byte_at(5)] ^ t[1][byte_at(6)] ^ t[0][byte_at(7)];
  }
  for (; left > 0; ++at, --left) remainder = (remainder >> 8) ^ t[0][(remainder ^ byte_at(0)) & 0xFF];
  return ~remainder;
}

}  // namespace sim
