// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace viewer {

/// Returns the time stamp at the start of the payload of a `sim.*` message, us since 1970 and simulated; none for a
/// payload that is too short.
std::optional<std::int64_t> stamp_of(std::span<const std::byte> payload);

/// Simulated times of messages, computed from the stamps of a log or a bus, which may be of any clock, and from the
/// messages of the simulator, which know the simulated time.  us since 1970.
class MessageTimes {
 public:
  /// `start_us`: time before the first message of the simulator.
  explicit MessageTimes(std::int64_t start_us = 0) : simulated_us_(start_us) {}
  /// Takes the next message, of which `stamp_us` is the time in the log, or that of its arrival.
  void take(std::string_view channel, std::span<const std::byte> payload, std::int64_t stamp_us);

  /// Returns the time of the message: its stamp, moved by what the last message of the simulator was off.  Two messages
  /// never have the same time only because the simulator says nothing in between; but the time may go back a little.
  std::int64_t interpolated_us() const { return stamp_us_ + offset_us_; }
  /// Returns the time of the message that never goes back without a rewind: its stamp in a record of Shoal, else the
  /// time of the last message of the simulator.
  std::int64_t steady_us() const { return is_simulated_ ? stamp_us_ : simulated_us_; }

 private:
  std::int64_t stamp_us_ = 0, simulated_us_;
  std::int64_t offset_us_ = 0;  // of the simulated time from the stamps
  bool is_simulated_ = false;   // the stamps are the simulated time
};

}  // namespace viewer
