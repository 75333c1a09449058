// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "sim/base/time.hpp"
#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Event at a simulated time for one device (a delayed report, a delayed command, an arrival) or for the acoustic
/// channel.  Plain data, so that the queue can be hashed and saved.
struct Event {
  static constexpr int of_acoustics = -2;  ///< device number of the acoustic channel

  Time due{0};
  std::uint64_t sequence = 0;  ///< order of scheduling; breaks ties
  int device = -1;             ///< number of the device in the world
  int kind = 0;                ///< defined by the receiver
  Time stamp{0};               ///< defined by the receiver
  Bytes payload;

  void visit_state(StateArchive& archive) {
    archive(due, device, kind, stamp, payload);
    archive.unhashed(sequence);
  }
};

/// Queue of events in the order of (due, sequence).
class EventQueue {
 public:
  void schedule(Event event);
  /// Removes the next event that is due at or before `now`; returns false when there is none.
  bool take_due(Time now, Event& event);
  /// Returns the stamp of an event about `events` places ahead, if it belongs to this device: a hint for prefetching
  /// its memory, which may be absent.
  std::optional<Time> stamp_ahead(std::size_t events, int device) const {
    if (next_ + events >= sorted_.size() || sorted_[next_ + events].device != device) return std::nullopt;
    return sorted_[next_ + events].stamp;
  }
  /// Calls use(stamp, device, kind) for each event that is due at or before `now`, in no particular order.
  template <typename Use>
  void for_each_due(Time now, const Use& use) {
    reach(slice_of(now));
    for (std::size_t i = next_; i < sorted_.size() && sorted_[i].due <= now; ++i)
      use(sorted_[i].stamp, sorted_[i].device, sorted_[i].kind);
    for (const Entry& entry : late_)
      if (entry.due <= now) use(entry.stamp, entry.device, entry.kind);
  }
  /// Drops the events of a device that is removed.
  void drop_device(int device);
  std::size_t size() const { return size_; }
  /// Returns a hash of all events that is kept up to date, unlike that of visit_state().  The order of those due at the
  /// same time is not in it.
  std::uint64_t content_hash() const;
  void visit_state(StateArchive& archive);

 private:
  /// Event with its payload stored separately: most events have none.
  struct Entry {
    static constexpr int no_payload = -1;

    Time due;
    std::uint64_t sequence;
    Time stamp;
    int device, kind;
    int payload;  // index into payloads_
  };
  struct Earlier {
    bool operator()(const Entry& a, const Entry& b) const {
      return a.due != b.due ? a.due < b.due : a.sequence < b.sequence;
    }
  };
  struct Later {
    bool operator()(const Entry& a, const Entry& b) const { return Earlier()(b, a); }
  };
  /// Payload of an event.
  struct Payload {
    Bytes bytes;
    std::uint64_t event_hash = 0;  // of its event without it
    bool used = false;
  };
  /// Hash of an event without its payload.
  static std::uint64_t hash_of(const Entry& entry);
  /// Returns the slice of a time.  Slices are sorted when they are reached: a heap of all distant events would not fit
  /// into the cache.
  static std::int64_t slice_of(Time due) { return due.count() >> 14; }

  void insert(Event event);
  void reach(std::int64_t slice);
  Event take(const Entry& entry);
  template <typename Use>
  void for_each_in_order(const Use& use) const;

  std::vector<Entry> sorted_;  // up to the slice `reached_`; those before `next_` have been taken
  std::size_t next_ = 0;
  std::vector<Entry> late_;  // heap of events that were scheduled after their slice was reached
  std::map<std::int64_t, std::vector<Entry>> slices_;
  std::vector<std::vector<Entry>> spare_;  // empty, with reserved memory
  std::int64_t reached_ = -1;
  std::size_t size_ = 0;
  std::uint64_t sum_ = 0;  // of the hashes of all events, without payloads
  std::vector<Payload> payloads_;
  std::vector<int> free_payloads_;
  std::uint64_t next_sequence_ = 0;
};

}  // namespace sim
