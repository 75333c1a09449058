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

/// What happens at a simulated time to one device (a delayed report, a delayed command, an arrival) or to the acoustic
/// channel.  Plain data, so that the queue can be hashed and saved.
struct Event {
  static constexpr int of_acoustics = -2;  ///< in place of a device

  Time due{0};
  std::uint64_t sequence = 0;  ///< order of scheduling; breaks ties
  int device = -1;             ///< number of the device in the world
  int kind = 0;                ///< the receiver's own
  Time stamp{0};               ///< the receiver's own
  Bytes payload;

  void visit_state(StateArchive& archive) {
    archive(due, device, kind, stamp, payload);
    archive.unhashed(sequence);
  }
};

/// Events in the order of (due, sequence).
class EventQueue {
 public:
  void schedule(Event event);
  /// Takes the next event that is due at or before `now`; false when there is none.
  bool take_due(Time now, Event& event);
  /// The stamp of an event about this many events ahead, if it belongs to this device: for prefetching its memory.
  ///   Nothing is lost when there is none.
  std::optional<Time> stamp_ahead(std::size_t events, int device) const {
    if (next_ + events >= sorted_.size() || sorted_[next_ + events].device != device) return std::nullopt;
    return sorted_[next_ + events].stamp;
  }
  /// Drops what waits for a device that goes.
  void drop_device(int device);
  std::size_t size() const { return size_; }
  void visit_state(StateArchive& archive);

 private:
  /// An event, with its payload elsewhere: most have none.
  struct Entry {
    static constexpr int no_payload = -1;

    Time due;
    std::uint64_t sequence;
    Time stamp;
    int device, kind;
    int payload;  // its place in payloads_
  };
  struct Earlier {
    bool operator()(const Entry& a, const Entry& b) const {
      return a.due != b.due ? a.due < b.due : a.sequence < b.sequence;
    }
  };
  struct Later {
    bool operator()(const Entry& a, const Entry& b) const { return Earlier()(b, a); }
  };
  /// Times are cut into slices, which are sorted when they are reached: a heap of all that waits for long would not fit
  /// into the cache.
  static std::int64_t slice_of(Time due) { return due.count() >> 14; }

  void insert(Event event);
  void reach(std::int64_t slice);
  Event take(const Entry& entry);
  template <typename Use>
  void for_each(const Use& use) const;

  std::vector<Entry> sorted_;  // up to the slice `reached_`; those before `next_` were taken
  std::size_t next_ = 0;
  std::vector<Entry> late_;  // a heap: scheduled when their slice had been reached
  std::map<std::int64_t, std::vector<Entry>> slices_;
  std::vector<std::vector<Entry>> spare_;  // empty, with memory
  std::int64_t reached_ = -1;
  std::size_t size_ = 0;
  std::vector<Bytes> payloads_;
  std::vector<int> free_payloads_;
  std::uint64_t next_sequence_ = 0;
};

}  // namespace sim
