// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page_data/earlier_events.hpp"

#include <algorithm>
#include <utility>

namespace viewer {

void EarlierEvents::add(std::string event) {
  events_.push_back(std::move(event));
  if (events_.size() <= max_events) return;
  events_.pop_front();
  ++dropped_;
}

void EarlierEvents::page_left() {
  clients_ = std::max(0, clients_ - 1);
}

std::optional<std::string> EarlierEvents::text_for(int clients) {
  if (clients <= std::exchange(clients_, clients) || events_.empty()) return std::nullopt;
  std::string items;
  for (const std::string& event : events_) items += (items.empty() ? "" : ",") + event;
  return "{\"op\":\"events\",\"all\":true,\"dropped\":" + std::to_string(dropped_) + ",\"items\":[" + items + "]}";
}

}  // namespace viewer
