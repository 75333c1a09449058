// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "sim/acoustics/numbered_pool.hpp"
#include "sim/event/event_queue.hpp"

namespace sim {

/// Kind of an event of the acoustic channel; part of snapshots.  `near` is shortly before an arrival, when its time is
/// computed exactly; `start` and `end` are those of a signal at a receiver; `silence` is that of a truncated signal
/// there; `watch` checks active senders and receivers.
enum class AcousticEvent : int { transmission_start, transmission_end, near, start, end, watch, silence };

/// Whether the event belongs to a transmission, or else to a flight or, `watch`, to neither.
inline bool is_of_transmission(AcousticEvent kind) {
  return kind == AcousticEvent::transmission_start || kind == AcousticEvent::transmission_end;
}
/// Whether each flight has exactly one event of these kinds.
inline bool is_of_flight(AcousticEvent kind) {
  return kind == AcousticEvent::near || kind == AcousticEvent::start || kind == AcousticEvent::end;
}

/// Schedules an event of the channel.  `number`: of its transmission or flight.
inline void schedule(EventQueue& queue, Time due, AcousticEvent kind, int number) {
  Event event;
  event.due = due;
  event.device = Event::of_acoustics;
  event.kind = static_cast<int>(kind);
  event.stamp = Time{number};
  queue.schedule(std::move(event));
}

/// Effects of an event at a receiver on anything outside of the receiver and its flights, so that threads can handle
/// events at different receivers: they are applied later, in the order of the events.
struct ArrivalEffects {
  struct Due {
    Time at{0};
    AcousticEvent kind = AcousticEvent::near;
  };
  std::array<Due, 2> events;  ///< to be scheduled, of the same flight
  std::uint8_t count = 0;     ///< of events
  bool ended = false;         ///< the flight
  std::uint64_t sum = 0;      ///< change of the sum of the hashes of flights
  void schedule(Time at, AcousticEvent kind) { events[count++] = {at, kind}; }
};

}  // namespace sim
