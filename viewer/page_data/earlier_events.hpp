// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace viewer {

/// Events of a run up to now, for pages that connect later.
class EarlierEvents {
 public:
  /// Maximum number of events; the oldest are forgotten and counted.
  static constexpr std::size_t max_events = 1000;

  /// Keeps an event: a JSON text as in `items` of the text `events`.
  void add(std::string event);
  /// Notes that a page has left.
  void page_left();
  /// Returns the text `events` with all of them if a page has connected since the last call; none: not needed.
  /// `clients`: number of pages now.
  std::optional<std::string> text_for(int clients);

 private:
  std::deque<std::string> events_;
  std::int64_t dropped_ = 0;
  int clients_ = 0;  // that have got the events
};

}  // namespace viewer
