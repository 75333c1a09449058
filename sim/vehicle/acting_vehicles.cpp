// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/acting_vehicles.hpp"

#include <algorithm>

#include "sim/vehicle/mounted_device.hpp"
#include "sim/vehicle/step_clock.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace sim {

void ActingVehicles::clear() {
  entries_.clear();
  vehicles_.clear();
  shared_flags_.clear();
  in_turn_.clear();
  of_group_.clear();
  places_known_ = false;
  some_fresh_ = false;
}

void ActingVehicles::add(const Vehicle& vehicle) {
  Range range{&vehicle, static_cast<std::uint32_t>(entries_.size()),
              0,        static_cast<std::uint32_t>(shared_flags_.size()),
              0,        true,
              true};
  for (const MountedDevice* device : vehicle.devices()) {
    if (device->acting()->actuator == nullptr) continue;
    entries_.push_back({device->acting(), device->awake(), static_cast<std::uint32_t>(device->number())});
    if (device->acts_alone()) continue;
    if (device->awake() != nullptr)
      shared_flags_.push_back(device->awake());
    else
      range.alone = false;
  }
  range.end = static_cast<std::uint32_t>(entries_.size());
  range.flags_end = static_cast<std::uint32_t>(shared_flags_.size());
  if (range.begin == range.end) return;
  // Numbers of removed devices are reused, so that they need not ascend.
  std::sort(entries_.begin() + range.begin, entries_.end(),
            [](const Entry& a, const Entry& b) { return a.rank < b.rank; });
  vehicles_.push_back(range);
  places_known_ = false;
  some_fresh_ = true;
}

void ActingVehicles::remove(const Vehicle& vehicle) {
  // Search from the end: vehicles that come and go are the last ones.
  const auto found =
      std::find_if(vehicles_.rbegin(), vehicles_.rend(), [&](const Range& range) { return range.vehicle == &vehicle; });
  if (found == vehicles_.rend()) return;
  const Range removed = *found;
  places_known_ = false;
  entries_.erase(entries_.begin() + removed.begin, entries_.begin() + removed.end);
  shared_flags_.erase(shared_flags_.begin() + removed.flags_begin, shared_flags_.begin() + removed.flags_end);
  for (auto later = vehicles_.erase(found.base() - 1); later != vehicles_.end(); ++later) {
    later->begin -= removed.end - removed.begin;
    later->end -= removed.end - removed.begin;
    later->flags_begin -= removed.flags_end - removed.flags_begin;
    later->flags_end -= removed.flags_end - removed.flags_begin;
  }
}

bool ActingVehicles::begin_by_groups() {
  if (!places_known_) {
    of_group_.clear();
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      const auto group = static_cast<std::size_t>(vehicles_[i].vehicle->group());
      if (of_group_.size() <= group) of_group_.resize(group + 1, -1);
      of_group_[group] = static_cast<int>(i);
    }
    places_known_ = true;
  }
  failure_.emplace();
  acted_.assign(vehicles_.size(), false);
  // Groups can be stepped one by one only if no vehicle acts on the body of another.
  return std::all_of(vehicles_.begin(), vehicles_.end(), [this](const Range& vehicle) { return acts_alone(vehicle); });
}

void ActingVehicles::act_of(int group, const StepClock& clock, double step_s) {
  const auto number = static_cast<std::size_t>(group);
  if (number >= of_group_.size() || of_group_[number] < 0) return;
  const auto place = static_cast<std::size_t>(of_group_[number]);
  acted_[place] = true;
  for (std::uint32_t k = vehicles_[place].begin; k < vehicles_[place].end; ++k)
    act(entries_[k], clock, step_s, *failure_);
}

void ActingVehicles::act_rest(const StepClock& clock, double step_s, ThreadPool* threads) {
  for_each_block(threads, vehicles_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!acted_[i])
        for (std::uint32_t k = vehicles_[i].begin; k < vehicles_[i].end; ++k)
          act(entries_[k], clock, step_s, *failure_);
  });
  failure_->rethrow();
}

bool ActingVehicles::acts_alone(const Range& vehicle) const {
  if (vehicle.fresh || !vehicle.alone) return false;
  for (std::uint32_t i = vehicle.flags_begin; i < vehicle.flags_end; ++i)
    if (shared_flags_[i]->load(std::memory_order_relaxed)) return false;
  return true;
}

void ActingVehicles::act(const Entry& entry, const StepClock& clock, double step_s, FirstFailure& failure) const {
  if (entry.awake != nullptr && !entry.awake->load(std::memory_order_relaxed)) return;
  try {
    entry.acting->act(clock.now(), step_s);
    // A stuck device repeats its last reports.
    if (entry.awake != nullptr && !entry.acting->stuck && entry.acting->actuator->idle())
      entry.awake->store(false, std::memory_order_relaxed);
  } catch (...) {
    failure.take(entry.rank);
  }
}

void ActingVehicles::act(const StepClock& clock, double step_s, ThreadPool* threads) {
  FirstFailure failure;
  const auto act_alone = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Range& vehicle = vehicles_[i];
      if (!acts_alone(vehicle)) continue;
      for (std::uint32_t k = vehicle.begin; k < vehicle.end; ++k) act(entries_[k], clock, step_s, failure);
    }
  };
  // Those that do not act alone: found first, because acting puts devices to sleep.
  in_turn_.clear();
  for (const Range& vehicle : vehicles_)
    if (!acts_alone(vehicle))
      in_turn_.insert(in_turn_.end(), entries_.begin() + vehicle.begin, entries_.begin() + vehicle.end);
  for_each_block(threads, vehicles_.size(), act_alone);
  std::sort(in_turn_.begin(), in_turn_.end(), [](const Entry& a, const Entry& b) { return a.rank < b.rank; });
  for (const Entry& entry : in_turn_) act(entry, clock, step_s, failure);
  if (some_fresh_)
    for (Range& vehicle : vehicles_) vehicle.fresh = false;
  some_fresh_ = false;
  failure.rethrow();
}

}  // namespace sim
