// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace bridges {

/// Finds where the time stamps of a log go back, as in logs that were joined, or after a clock was set back.
class TimeOrder {
 public:
  /// Call for each event, in the order of the log.
  void add(std::int64_t utime, std::string_view channel);
  /// Returns a line about the first event before its predecessor, with the number of such events; none: there is none.
  std::optional<std::string> problem() const;
  /// Time from the earliest to the latest event, s.
  double span_s() const;

 private:
  std::uint64_t events_ = 0, back_ = 0, first_event_ = 0;
  std::int64_t last_ = 0, earliest_ = 0, latest_ = 0;
  double first_back_s_ = 0;
  std::string first_channel_;
};

}  // namespace bridges
