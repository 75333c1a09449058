// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/deferred_arrivals.hpp"

#include <algorithm>

namespace sim {

void DeferredArrivals::add(FlightId flight, AcousticEvent kind, Time due, int receiver) {
  const auto at = static_cast<std::size_t>(receiver + 1);
  if (at >= ends_.size()) ends_.resize(at + 1, {-1, -1});
  const auto added = static_cast<int>(events_.size());
  auto& [first, last] = ends_[at];
  if (first < 0) {
    first = added;
    receivers_.push_back(at);
  } else {
    event(last).next = added;
  }
  last = added;
  events_.push_back({flight, kind, due, -1, {}});
}

void DeferredArrivals::handle(Time until, ThreadPool* threads, const Handle& handle, const Apply& apply) {
  handled_ += static_cast<std::int64_t>(events_.size());
  for_each_block(threads, receivers_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) handle_at_receiver(ends_[receivers_[i]][0], until, handle);
  });
  for (const Deferred& each : events_) apply(each.flight, each.effects);
  for (const std::size_t at : receivers_) ends_[at] = {-1, -1};
  receivers_.clear();
  events_.clear();
}

void DeferredArrivals::clear() {
  events_.clear();
  ends_.clear();
  receivers_.clear();
}

/// Handles the deferred events at a receiver, `first` and those after it, and the starts before `until` that follow.
void DeferredArrivals::handle_at_receiver(int first, Time until, const Handle& handle) {
  struct Start {
    Time at;
    Deferred* of;
  };
  std::vector<Start> starts;  // by time
  std::size_t next_start = 0;
  for (int next = first; next >= 0 || next_start < starts.size();) {
    // Take the earlier one; at the same time, that which was scheduled earlier.
    Deferred* const listed = next >= 0 ? &event(next) : nullptr;
    const bool starts_now = listed == nullptr || (next_start < starts.size() && starts[next_start].at < listed->due);
    Deferred& each = starts_now ? *starts[next_start].of : *listed;
    ArrivalEffects& effects = each.effects;
    if (starts_now) {
      const Time at = starts[next_start++].at;
      handle(each.flight, AcousticEvent::start, at, effects);
    } else {
      next = each.next;
      handle(each.flight, each.kind, each.due, effects);
    }
    // Keep a start that is due before `until`.
    if (effects.count != 1 || effects.events[0].kind != AcousticEvent::start || effects.events[0].at >= until) continue;
    effects.count = 0;
    const Time at = effects.events[0].at;
    const auto later = std::upper_bound(starts.begin() + static_cast<std::ptrdiff_t>(next_start), starts.end(), at,
                                        [](Time time, const Start& start) { return time < start.at; });
    starts.insert(later, {at, &each});
  }
}

}  // namespace sim
