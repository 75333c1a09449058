// SPDX-License-Identifier: BSD-3-Clause
#include "sim/nmea/nmea.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "sim/base/number.hpp"

namespace sim {

const std::string& NmeaSentence::at(std::size_t i) const {
  static const std::string none;
  return i < fields.size() ? fields[i] : none;
}

std::optional<int> NmeaSentence::number(std::size_t i, int min, int max) const {
  const std::optional<int> value = exact_number<int>(at(i));
  return value && *value >= min && *value <= max ? value : std::nullopt;
}

unsigned nmea_checksum(std::string_view body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return sum;
}

std::string nmea_sentence(std::string_view body, char start) {
  char end[8];
  std::snprintf(end, sizeof end, "*%02X", nmea_checksum(body));
  return start + std::string(body) + end;
}

NmeaError parse_nmea(std::string_view line, NmeaSentence& sentence, char start) {
  const std::size_t begin = line.rfind(start);
  if (begin == std::string_view::npos) return NmeaError::no_sentence;
  std::string_view body = line.substr(begin + 1);
  // Verify the checksum.
  const std::size_t star = body.find('*');
  unsigned expected = 0;
  if (star != std::string_view::npos) {
    const std::string_view digits = body.substr(star + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), expected, 16);
    if (digits.size() != 2 || error != std::errc{} || end != digits.data() + 2) return NmeaError::bad_checksum;
    body = body.substr(0, star);
    if (nmea_checksum(body) != expected) return NmeaError::bad_checksum;
  }
  // Refuse non-printable characters.
  const auto printable = [](char c) { return c >= 0x20 && c < 0x7f; };
  if (body.empty() || !std::all_of(body.begin(), body.end(), printable)) return NmeaError::no_sentence;
  // Split the body into fields.
  sentence.fields.clear();
  for (std::size_t at = 0; at <= body.size();) {
    const std::size_t comma = std::min(body.find(',', at), body.size());
    sentence.fields.emplace_back(body.substr(at, comma - at));
    at = comma + 1;
  }
  return NmeaError::none;
}

std::vector<NmeaLines::Line> NmeaLines::add(std::span<const std::byte> bytes) {
  std::vector<Line> lines;
  for (const std::byte byte : bytes) {
    const char c = static_cast<char>(byte);
    // Either character ends a line, so that CR LF gives an empty line, which is none.
    if (c == '\n' || c == '\r') {
      if (!line_.empty()) lines.push_back({std::move(line_), too_long_});
      line_.clear();
      too_long_ = false;
    } else if (line_.size() < longest) {
      // A sender without line ends must not fill the memory; the rest of such a line is dropped and the line marked.
      line_.push_back(c);
    } else {
      too_long_ = true;
    }
  }
  return lines;
}

std::string to_hex(std::span<const std::byte> bytes) {
  constexpr char digits[] = "0123456789abcdef";
  std::string text;
  for (const std::byte byte : bytes) {
    text.push_back(digits[std::to_integer<unsigned>(byte) >> 4]);
    text.push_back(digits[std::to_integer<unsigned>(byte) & 15]);
  }
  return text;
}

std::optional<Bytes> from_hex(std::string_view text) {
  if (text.size() % 2 != 0) return {};
  Bytes bytes;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    unsigned value = 0;
    const auto [end, error] = std::from_chars(text.data() + i, text.data() + i + 2, value, 16);
    if (error != std::errc{} || end != text.data() + i + 2) return {};
    bytes.push_back(static_cast<std::byte>(value));
  }
  return bytes;
}

}  // namespace sim
