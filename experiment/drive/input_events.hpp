// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace experiment {

/// Event of an input device of Linux (linux/input.h): a button, an axis, or the end of a report.
struct InputEvent {
  // Types.
  static constexpr std::uint16_t report = 0, button = 1, axis = 3;
  // Codes of `report`: the end of a report, and events that the kernel has dropped.
  static constexpr std::uint16_t report_end = 0, report_dropped = 3;

  std::int64_t time_us = 0;
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;  ///< of a button: 0 up, 1 down, 2 repeated
};

/// Reader of `struct input_event` as 64-bit Linux writes it, from /dev/input/eventX or a copy of it: i64 seconds, i64
/// microseconds, u16 type, u16 code, i32 value, little-endian.
class InputEventReader {
 public:
  static constexpr std::size_t event_bytes = 24;

  /// Takes bytes in pieces of any length.
  void add(std::span<const std::byte> bytes);
  /// Returns the next complete event.  Throws DriveError, with the number of the event, for one that Linux does not
  /// write.
  std::optional<InputEvent> next();
  /// Returns whether the bytes end inside an event.
  bool is_cut() const { return at_ < bytes_.size(); }
  /// Returns the count of events read so far.
  std::int64_t count() const { return count_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
  std::int64_t count_ = 0;
};

/// Reads a file of events.  Throws DriveError with the name of the file.
std::vector<InputEvent> read_input_events(const std::string& file);

/// Returns the bytes of an event, as the reader takes them.
std::vector<std::byte> bytes_of(const InputEvent& event);

}  // namespace experiment
