#include "sim/world/event_queue.hpp"

#include <algorithm>

namespace sim {

namespace {

bool later(const Event& a, const Event& b) {
  return a.due != b.due ? a.due > b.due : a.sequence > b.sequence;
}

}  // namespace

void EventQueue::schedule(Event event) {
  event.sequence = next_sequence_++;
  heap_.push_back(std::move(event));
  std::push_heap(heap_.begin(), heap_.end(), later);
}

bool EventQueue::take_due(Time now, Event& event) {
  if (heap_.empty() || heap_.front().due > now) return false;
  std::pop_heap(heap_.begin(), heap_.end(), later);
  event = std::move(heap_.back());
  heap_.pop_back();
  return true;
}

void EventQueue::forget_device(int device) {
  if (std::erase_if(heap_, [&](const Event& event) { return event.device == device; }) > 0)
    std::make_heap(heap_.begin(), heap_.end(), later);
}

void EventQueue::hash_state(StateHash& hash) const {
  // The heap's layout depends on its history; the order of delivery is what counts.
  std::vector<const Event*> ordered;
  for (const Event& event : heap_) ordered.push_back(&event);
  std::sort(ordered.begin(), ordered.end(), [](const Event* a, const Event* b) { return later(*b, *a); });
  hash.add(static_cast<std::uint64_t>(ordered.size()));
  for (const Event* event : ordered) {
    hash.add(static_cast<std::int64_t>(event->due.count()));
    hash.add(event->device);
    hash.add(event->kind);
    hash.add(static_cast<std::int64_t>(event->stamp.count()));
    hash.add_bytes(event->payload.data(), event->payload.size());
  }
}

}  // namespace sim
