// SPDX-License-Identifier: BSD-3-Clause
#include "sim/event/event_queue.hpp"

#include <algorithm>
#include <utility>

#include "sim/base/record_hash.hpp"
#include "sim/base/state_hash.hpp"

namespace sim {

void EventQueue::schedule(Event event) {
  event.sequence = next_sequence_++;
  insert(std::move(event));
}

void EventQueue::insert(Event event) {
  Entry entry{event.due, event.sequence, event.stamp, event.device, event.kind, Entry::no_payload};
  // Store the payload.
  if (!event.payload.empty()) {
    if (free_payloads_.empty()) {
      free_payloads_.push_back(static_cast<int>(payloads_.size()));
      payloads_.emplace_back();
    }
    entry.payload = free_payloads_.back();
    free_payloads_.pop_back();
    payloads_[static_cast<std::size_t>(entry.payload)] = {std::move(event.payload), hash_of(entry), true};
  }
  ++size_;
  sum_ += hash_of(entry);
  // Insert into a later slice, or into the heap of late events.
  if (const std::int64_t slice = slice_of(event.due); slice > reached_) {
    const auto [found, is_new] = slices_.try_emplace(slice);
    if (is_new && !spare_.empty()) {
      found->second = std::move(spare_.back());
      spare_.pop_back();
    }
    found->second.push_back(entry);
  } else {
    late_.push_back(entry);
    std::push_heap(late_.begin(), late_.end(), Later());
  }
}

/// Appends the events due up to the end of this slice, sorted.
void EventQueue::reach(std::int64_t slice) {
  if (slice <= reached_) return;
  reached_ = slice;
  if (slices_.empty() || slices_.begin()->first > slice) return;
  sorted_.erase(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(next_));
  next_ = 0;
  while (!slices_.empty() && slices_.begin()->first <= slice) {
    std::vector<Entry>& entries = slices_.begin()->second;
    const auto old = static_cast<std::ptrdiff_t>(sorted_.size());
    sorted_.insert(sorted_.end(), entries.begin(), entries.end());
    std::sort(sorted_.begin() + old, sorted_.end(), Earlier());
    entries.clear();
    constexpr std::size_t max_spare = 256;
    if (spare_.size() < max_spare) spare_.push_back(std::move(entries));
    slices_.erase(slices_.begin());
  }
}

Event EventQueue::take(const Entry& entry) {
  Event event{entry.due, entry.sequence, entry.device, entry.kind, entry.stamp, {}};
  if (entry.payload != Entry::no_payload) {
    event.payload = std::exchange(payloads_[static_cast<std::size_t>(entry.payload)], {}).bytes;
    free_payloads_.push_back(entry.payload);
  }
  --size_;
  sum_ -= hash_of(entry);
  return event;
}

bool EventQueue::take_due(Time now, Event& event) {
  reach(slice_of(now));
  const Entry* const first = next_ < sorted_.size() ? &sorted_[next_] : nullptr;
  if (!late_.empty() && (first == nullptr || Earlier()(late_.front(), *first))) {
    if (late_.front().due > now) return false;
    std::pop_heap(late_.begin(), late_.end(), Later());
    event = take(late_.back());
    late_.pop_back();
    return true;
  }
  if (first == nullptr || first->due > now) return false;
  event = take(*first);
  ++next_;
  return true;
}

void EventQueue::drop_device(int device) {
  const auto of_device = [&](const Entry& entry) {
    if (entry.device != device) return false;
    take(entry);
    return true;
  };
  sorted_.erase(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(next_));
  next_ = 0;
  std::erase_if(sorted_, of_device);
  if (std::erase_if(late_, of_device) > 0) std::make_heap(late_.begin(), late_.end(), Later());
  for (auto& [slice, entries] : slices_) std::erase_if(entries, of_device);
}

/// Calls use(entry) in the order of delivery.  Slices are sorted one by one, which is faster than all events at once.
template <typename Use>
void EventQueue::for_each_in_order(const Use& use) const {
  std::vector<Entry> ordered(sorted_.begin() + static_cast<std::ptrdiff_t>(next_), sorted_.end());
  ordered.insert(ordered.end(), late_.begin(), late_.end());
  const auto use_sorted = [&] {
    std::sort(ordered.begin(), ordered.end(), Earlier());
    for (const Entry& entry : ordered) use(entry);
  };
  use_sorted();
  for (const auto& [slice, entries] : slices_) {
    ordered = entries;
    use_sorted();
  }
}

std::uint64_t EventQueue::hash_of(const Entry& entry) {
  return record_hash({static_cast<std::uint64_t>(entry.due.count()), word_of(entry.device, entry.kind),
                      static_cast<std::uint64_t>(entry.stamp.count()), 0});
}

std::uint64_t EventQueue::content_hash() const {
  std::uint64_t of_payloads = 0;
  for (const Payload& payload : payloads_) {
    if (!payload.used) continue;
    StateHash hash;
    hash.add(payload.event_hash);
    hash.add_bytes(payload.bytes.data(), payload.bytes.size());
    // A sum does not depend on the order of the payloads' slots, which differs after a snapshot is restored.
    of_payloads += hash.value();
  }
  StateHash hash;
  hash.add(static_cast<std::uint64_t>(size_));
  hash.add(sum_);
  hash.add(of_payloads);
  return hash.value();
}

/// Visits the events in the order of delivery, because their storage depends on the history.
void EventQueue::visit_state(StateArchive& archive) {
  archive.unhashed(reached_, next_sequence_);
  if (archive.restoring()) {
    // Restore into an empty queue.
    std::vector<Event> events;
    archive(events);
    const std::int64_t reached = reached_;
    const std::uint64_t next_sequence = next_sequence_;
    *this = {};
    reached_ = reached;
    next_sequence_ = next_sequence;
    for (Event& event : events) {
      if (event.device < 0 && event.device != Event::of_acoustics) archive.fail("an event without a device");
      insert(std::move(event));
    }
    return;
  }
  // Hash or save the events.
  auto size = static_cast<std::uint64_t>(size_);  // format of archive(std::vector<Event>)
  archive(size);
  for_each_in_order([&](const Entry& entry) {
    Event event{entry.due, entry.sequence, entry.device, entry.kind, entry.stamp, {}};
    // Move payloads out and back, so that hashing copies no camera images.
    Bytes* const payload =
        entry.payload != Entry::no_payload ? &payloads_[static_cast<std::size_t>(entry.payload)].bytes : nullptr;
    if (payload != nullptr) std::swap(event.payload, *payload);
    archive(event);
    if (payload != nullptr) std::swap(event.payload, *payload);
  });
}

}  // namespace sim
