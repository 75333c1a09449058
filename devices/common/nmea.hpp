// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// A sentence as of NMEA 0183: `$CCMPC,1,2*5E`.
struct NmeaSentence {
  std::vector<std::string> fields;  ///< the first is the name, without `$`

  const std::string& name() const { return fields.front(); }
  /// Field `i`, counted from the one after the name as 1; empty where there is none.
  const std::string& at(std::size_t i) const;
  std::size_t count() const { return fields.size() - 1; }
  /// A whole number in a range; nothing when the field is anything else.
  std::optional<int> number(std::size_t i, int min, int max) const;
};

/// What reading a line gave.
enum class NmeaError { none, no_sentence, bad_checksum };

/// The exclusive or of all characters.
unsigned nmea_checksum(std::string_view body);
/// `$`, what is given, `*` and the checksum.
std::string nmea_sentence(std::string_view body);
/// Reads a line without its end.  What stands before the `$` is passed over; a checksum may be missing, but must be
/// right where it is.  A line with characters that cannot be printed is not a sentence.
NmeaError parse_nmea(std::string_view line, NmeaSentence& sentence);

/// Makes lines of bytes as they come.  Memory is bounded for any input.
class NmeaLines {
 public:
  struct Line {
    std::string text;
    bool too_long = false;  ///< the text is not all of it
  };
  /// Lines that have ended, the empty ones left out.
  std::vector<Line> add(std::span<const std::byte> bytes);
  void visit_state(sim::StateArchive& archive) { archive(line_, too_long_); }

  /// Room for a frame of 256 bytes in hexadecimal digits.
  static constexpr std::size_t longest = 640;

 private:
  std::string line_;
  bool too_long_ = false;
};

/// Two digits for each byte, small letters.
std::string to_hex(std::span<const std::byte> bytes);
/// Nothing when it is not an even number of hexadecimal digits.
std::optional<sim::Bytes> from_hex(std::string_view text);

}  // namespace devices
