// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/png_check.hpp"

#include <cstdint>
#include <span>

#include "sim/base/crc32.hpp"

namespace experiment {

namespace {

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

}  // namespace

// Portable Network Graphics (W3C), section 5: chunks of length, type, data and CRC-32 of type and data.
bool is_whole_png(std::string_view bytes) {
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
  constexpr std::size_t around = 12;  // bytes of a chunk in addition to its data
  if (!bytes.starts_with(signature)) return false;
  bool first = true;
  for (std::size_t at = signature.size(); bytes.size() - at >= around; first = false) {
    const std::size_t length = number_at(bytes, at);
    if (length > bytes.size() - at - around) return false;
    const std::string_view body = bytes.substr(at + 4, 4 + length);
    if (sim::crc32(std::as_bytes(std::span(body))) != number_at(bytes, at + 8 + length)) return false;
    if (first && !body.starts_with("IHDR")) return false;
    at += around + length;
    if (body.starts_with("IEND")) return at == bytes.size();
  }
  return false;
}

}  // namespace experiment
