// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// NMEA 0183 sentence, such as `$CCMPC,1,2*5E`; those of AIS begin with `!` in place of `$`.
struct NmeaSentence {
  std::vector<std::string> fields;  ///< the first is the name, without the start character

  const std::string& name() const { return fields.front(); }
  /// Returns field `i`, where 1 is the field after the name; empty when there is none.
  const std::string& at(std::size_t i) const;
  std::size_t count() const { return fields.size() - 1; }
  /// Returns a field as an integer within a range; none when it is anything else.
  std::optional<int> number(std::size_t i, int min, int max) const;
};

/// Result of parsing a line.
enum class NmeaError { none, no_sentence, bad_checksum };

/// Returns the exclusive or of all characters.
unsigned nmea_checksum(std::string_view body);
/// Returns the sentence `$BODY*CHECKSUM`.
std::string nmea_sentence(std::string_view body, char start = '$');
/// Parses a line without its line end.  Text before the start character is skipped; a checksum is optional, but must be
/// correct when present.  A line with non-printable characters is not a sentence.
NmeaError parse_nmea(std::string_view line, NmeaSentence& sentence, char start = '$');

/// Splitter of a byte stream into lines.  Memory is bounded for any input.
class NmeaLines {
 public:
  struct Line {
    std::string text;
    bool too_long = false;  ///< the text is truncated
  };
  /// Returns the completed lines, without empty ones.
  std::vector<Line> add(std::span<const std::byte> bytes);
  void visit_state(StateArchive& archive) { archive(line_, too_long_); }

  /// Maximum length of a line, sufficient for a frame of 256 bytes in hexadecimal digits.
  static constexpr std::size_t longest = 640;

 private:
  std::string line_;
  bool too_long_ = false;
};

/// Returns two lower-case hexadecimal digits for each byte.
std::string to_hex(std::span<const std::byte> bytes);
/// Decodes hexadecimal digits; none when the text is not an even number of them.
std::optional<Bytes> from_hex(std::string_view text);

}  // namespace sim
