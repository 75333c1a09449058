// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/time_order.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "sim/config/message_text.hpp"

namespace bridges {

namespace {

/// Difference of two stamps, which may be anywhere in the range of their type, s.
double difference_s(std::int64_t later, std::int64_t earlier) {
  return 1e-6 * static_cast<double>(static_cast<std::uint64_t>(later) - static_cast<std::uint64_t>(earlier));
}

}  // namespace

void TimeOrder::add(std::int64_t utime, std::string_view channel) {
  if (events_++ == 0) last_ = earliest_ = latest_ = utime;
  if (utime < last_ && back_++ == 0) {
    first_event_ = events_;
    first_back_s_ = difference_s(last_, utime);
    first_channel_ = channel;
  }
  last_ = utime;
  earliest_ = std::min(earliest_, utime);
  latest_ = std::max(latest_, utime);
}

std::optional<std::string> TimeOrder::problem() const {
  if (back_ == 0) return std::nullopt;
  return fmt::format(
      "time goes back {}by {:.6g} s at event {} (channel '{}'): several logs in one, or a clock that was "
      "set back",
      back_ == 1 ? "" : fmt::format("{} times, first ", back_), first_back_s_, first_event_,
      sim::printable(sim::shortened(first_channel_)));
}

double TimeOrder::span_s() const {
  return difference_s(latest_, earliest_);
}

}  // namespace bridges
