#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/time.hpp"

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
  /// Drops what waits for a device that goes.
  void forget_device(int device);
  std::size_t size() const { return size_; }
  void visit_state(StateArchive& archive);

 private:
  void insert(Event event);
  /// What is moved about; the events stay where they are.
  struct Key {
    Time due;
    std::uint64_t sequence;
    std::size_t slot;
  };
  struct Later {
    bool operator()(const Key& a, const Key& b) const {
      return a.due != b.due ? a.due > b.due : a.sequence > b.sequence;
    }
  };
  /// Times are cut into slices: a heap of all that waits for long would not fit into the cache.
  static std::int64_t slice_of(Time due) { return due.count() >> 14; }

  std::vector<Key> heap_;  // up to the slice `reached_`
  std::map<std::int64_t, std::vector<Key>> slices_;
  std::int64_t reached_ = -1;
  std::size_t size_ = 0;
  std::vector<Event> events_;
  std::vector<std::size_t> free_slots_;
  std::uint64_t next_sequence_ = 0;
};

}  // namespace sim
