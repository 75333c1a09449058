// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "sim/acoustics/acoustic_events.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/base/time.hpp"

namespace sim {

/// Events at receivers that are handled together, receiver by receiver, so that threads can share the receivers.  This
/// class owns
/// - the deferred events in their order, chained by receiver,
/// - how many there were since the start.
///
/// handle() calls handlers in this order:
/// 1. for each receiver, in the threads: handle(flight, kind, due, effects) for its events, ascending in time.  A start
///    that follows from one of them before `until` takes its place among them; all other effects wait,
/// 2. apply(flight, effects) for each deferred event, in the order of their deferral.
///
/// The result is that of handling one after the other, whatever the threads, if a handler changes only the receiver,
/// its flights, and the effects.  No state: nothing is deferred between steps.
class DeferredArrivals {
 public:
  using Handle = std::function<void(FlightId, AcousticEvent, Time due, ArrivalEffects&)>;
  using Apply = std::function<void(FlightId, const ArrivalEffects&)>;

  bool empty() const { return events_.empty(); }
  /// Adds an event.  `receiver`: number of the transducer; negative: it was removed.
  void add(FlightId flight, AcousticEvent kind, Time due, int receiver);
  /// Handles all events, and discards them.  `threads` null: one thread.
  void handle(Time until, ThreadPool* threads, const Handle& handle, const Apply& apply);
  /// Discards the events of a step that failed.
  void clear();
  /// Number of events since the start.
  std::int64_t handled() const { return handled_; }

 private:
  struct Deferred {
    FlightId flight;
    AcousticEvent kind = AcousticEvent::near;
    Time due{0};
    int next = -1;  // at the same receiver
    ArrivalEffects effects;
  };
  void handle_at_receiver(int first, Time until, const Handle& handle);
  Deferred& event(int index) { return events_[static_cast<std::size_t>(index)]; }

  std::vector<Deferred> events_;
  std::vector<std::array<int, 2>> ends_;  // by receiver, of removed ones the first: first and last event, or -1
  std::vector<std::size_t> receivers_;    // those that have any, in the order of their first event
  std::int64_t handled_ = 0;
};

}  // namespace sim
