#include "sim/world/event_queue.hpp"

#include <algorithm>
#include <tuple>

namespace sim {

void EventQueue::schedule(Event event) {
  event.sequence = next_sequence_++;
  insert(std::move(event));
}

void EventQueue::insert(Event event) {
  if (free_slots_.empty()) {
    free_slots_.push_back(events_.size());
    events_.emplace_back();
  }
  const std::size_t slot = free_slots_.back();
  free_slots_.pop_back();
  const Key key{event.due, event.sequence, slot};
  if (const std::int64_t slice = slice_of(event.due); slice > reached_) {
    slices_[slice].push_back(key);
  } else {
    heap_.push_back(key);
    std::push_heap(heap_.begin(), heap_.end(), Later());
  }
  events_[slot] = std::move(event);
  ++size_;
}

bool EventQueue::take_due(Time now, Event& event) {
  while (!slices_.empty() && slices_.begin()->first <= slice_of(now)) {
    const auto slice = slices_.begin();
    heap_.insert(heap_.end(), slice->second.begin(), slice->second.end());
    std::make_heap(heap_.begin(), heap_.end(), Later());
    slices_.erase(slice);
  }
  reached_ = std::max(reached_, slice_of(now));
  if (heap_.empty() || heap_.front().due > now) return false;
  std::pop_heap(heap_.begin(), heap_.end(), Later());
  const std::size_t slot = heap_.back().slot;
  heap_.pop_back();
  event = std::move(events_[slot]);
  free_slots_.push_back(slot);
  --size_;
  return true;
}

void EventQueue::forget_device(int device) {
  const auto of_device = [&](const Key& key) {
    if (events_[key.slot].device != device) return false;
    events_[key.slot] = {};
    free_slots_.push_back(key.slot);
    --size_;
    return true;
  };
  for (auto& [slice, keys] : slices_) std::erase_if(keys, of_device);
  if (std::erase_if(heap_, of_device) > 0) std::make_heap(heap_.begin(), heap_.end(), Later());
}

/// The heap's layout depends on its history; the order of delivery is what counts.
void EventQueue::visit_state(StateArchive& archive) {
  archive.unhashed(reached_, next_sequence_);
  if (archive.restoring()) {
    std::vector<Event> events;
    archive(events);
    heap_.clear();
    slices_.clear();
    events_.clear();
    free_slots_.clear();
    size_ = 0;
    for (Event& event : events) {
      if (event.device < 0 && event.device != Event::of_acoustics) archive.fail("an event of nobody");
      insert(std::move(event));
    }
    return;
  }
  std::vector<Event*> ordered;
  ordered.reserve(size_);
  for (const Key& key : heap_) ordered.push_back(&events_[key.slot]);
  for (const auto& [slice, keys] : slices_)
    for (const Key& key : keys) ordered.push_back(&events_[key.slot]);
  std::sort(ordered.begin(), ordered.end(), [](const Event* a, const Event* b) {
    return std::tie(a->due, a->sequence) < std::tie(b->due, b->sequence);
  });
  auto size = static_cast<std::uint64_t>(ordered.size());  // as archive(std::vector<Event>) has it
  archive(size);
  for (Event* event : ordered) archive(*event);
}

}  // namespace sim
