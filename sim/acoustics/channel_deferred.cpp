// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "sim/acoustics/channel.hpp"
#include "sim/base/thread_pool.hpp"

// Events that threads handle together, receiver by receiver.  What an event changes outside of its receiver and its
// flight is carried out afterwards, in the order of the events.

namespace sim {

bool AcousticChannel::defer(const Event& event, Time now) {
  const bool arrives = event.kind == near_event || event.kind == start_event;
  if (!arrives && event.kind != end_event) return false;
  fetch_ahead();
  const int number = static_cast<int>(event.stamp.count());
  const Flight& flight = flights_[static_cast<std::size_t>(number)];
  if (arrives) {
    // The end of a short signal may be due in this step, and change more than its receiver.
    if (sendings_[static_cast<std::size_t>(flight.sending)]->signal.duration <= 2 * (now - event.due)) return false;
  } else if (flight.listened) {
    const Transducer* const to = receiver_of(flight);
    if (to != nullptr && (flight.detected || to->listener_.wants_undetected())) return false;
  }
  // Append to the events at the same receiver.
  deferred_at_.resize(std::max(deferred_at_.size(), transducers_.size() + 1), {-1, -1});
  const std::size_t at = flight.to < 0 ? transducers_.size() : static_cast<std::size_t>(flight.to);
  const auto added = static_cast<int>(deferred_.size());
  auto& [first, last] = deferred_at_[at];
  if (first < 0) {
    first = added;
    receivers_.push_back(at);
  } else {
    deferred_[static_cast<std::size_t>(last)].next = added;
  }
  last = added;
  deferred_.push_back({event.due, static_cast<EventKind>(event.kind), number, -1, {}});
  return true;
}

bool AcousticChannel::handle_deferred(Time until, Time now, ThreadPool* threads) {
  if (deferred_.empty()) return false;
  begin_handling(now);
  deferred_events_ += static_cast<std::int64_t>(deferred_.size());
  const Scene& scene = around_.physics.scene();
  if (config_.occlusion || config_.multipath || propagation_.bends()) scene.prepare();
  for_each_block(scene.concurrent() ? threads : nullptr, receivers_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) handle_at_receiver(deferred_at_[receivers_[i]][0], until);
  });
  for (const Deferred& each : deferred_) carry_out(each.flight, each.consequences);
  for (const std::size_t at : receivers_) deferred_at_[at] = {-1, -1};
  receivers_.clear();
  deferred_.clear();
  handling_ = false;
  return true;
}

/// Handles the deferred events at a receiver, `first` and those after it, and the starts before `until` that follow.
void AcousticChannel::handle_at_receiver(int first, Time until) {
  struct Start {
    Time at;
    Deferred* of;
  };
  std::vector<Start> starts;  // by time
  std::size_t next_start = 0;
  for (int next = first; next >= 0 || next_start < starts.size();) {
    // Take the earlier one; at the same time, that which was scheduled earlier.
    Deferred* const listed = next >= 0 ? &deferred_[static_cast<std::size_t>(next)] : nullptr;
    const bool starts_now = listed == nullptr || (next_start < starts.size() && starts[next_start].at < listed->due);
    Deferred& each = starts_now ? *starts[next_start].of : *listed;
    Consequences& out = each.consequences;
    if (starts_now) {
      const Time at = starts[next_start++].at;
      handle_at_receiver(each.flight, start_event, at, out);
    } else {
      next = each.next;
      handle_at_receiver(each.flight, each.kind, each.due, out);
    }
    // Keep a start that is due before `until`.
    if (out.count != 1 || out.events[0].kind != start_event || out.events[0].at >= until) continue;
    out.count = 0;
    const Time at = out.events[0].at;
    const auto later = std::upper_bound(starts.begin() + static_cast<std::ptrdiff_t>(next_start), starts.end(), at,
                                        [](Time time, const Start& start) { return time < start.at; });
    starts.insert(later, {at, &each});
  }
}

void AcousticChannel::handle_at_receiver(int flight, EventKind kind, Time due, Consequences& out) {
  if (kind == near_event) approach(flight, due, out);
  if (kind == start_event) begin(flight, out);
  if (kind == end_event) end_quietly(flight, out);
}

void AcousticChannel::carry_out(int flight, const Consequences& consequences) {
  flights_sum_ += consequences.sum;
  for (int i = 0; i < consequences.count; ++i) {
    const Consequences::Due& event = consequences.events[static_cast<std::size_t>(i)];
    schedule(event.at, event.kind, flight);
  }
  if (!consequences.ended) return;
  conclude(flight);
  discard(flight);
}

}  // namespace sim
