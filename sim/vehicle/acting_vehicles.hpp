// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/base/first_failure.hpp"
#include "sim/base/thread_pool.hpp"

namespace sim {

class Vehicle;
struct Acting;
struct StepClock;

/// Actuators of a world, by vehicle.
class ActingVehicles {
 public:
  void clear();
  /// Adds the actuators of a vehicle.
  void add(const Vehicle& vehicle);
  /// Removes the actuators of a vehicle, if it was added.
  void remove(const Vehicle& vehicle);
  /// Lets the actuators of every vehicle act, in device order.  Vehicles whose actuators all act alone (see Actuator)
  /// or sleep are shared among the threads; then the others act, in device order.  In its first step a vehicle is one
  /// of the others, because some actuators register with the physics then.  `threads` may be null.  An exception does
  /// not keep other actuators from acting; the one thrown at the end is that of the first device in device order.
  void act(const StepClock& clock, double step_s, ThreadPool* threads);

  /// Returns whether the actuators of all vehicles act alone, or sleep, in this step; then it may use act_of() and
  /// act_rest() instead of act().
  bool begin_by_groups();
  /// Lets the actuators of a group act; does nothing when it has none.  Threads may call it for several groups at once.
  void act_of(int group, const StepClock& clock, double step_s);
  /// Lets the vehicles act that did not act by act_of(), and throws as act() does.
  void act_rest(const StepClock& clock, double step_s, ThreadPool* threads);

 private:
  struct Entry {
    Acting* acting;
    std::atomic<bool>* awake;  // null: it never sleeps
    std::uint32_t rank;        // in device order
  };
  struct Range {
    const Vehicle* vehicle;
    std::uint32_t begin, end;              // of entries_
    std::uint32_t flags_begin, flags_end;  // of shared_flags_
    bool alone;  // its actuators act alone, except for those of the flags while they are awake
    bool fresh;  // they have not acted since the vehicle was added
  };
  void act(const Entry& entry, const StepClock& clock, double step_s, FirstFailure& failure) const;
  bool acts_alone(const Range& vehicle) const;

  std::vector<Entry> entries_;  // in the order of vehicles_, then in device order
  std::vector<Range> vehicles_;
  std::vector<std::atomic<bool>*> shared_flags_;  // of actuators that sleep and do not act alone
  std::vector<Entry> in_turn_;
  std::vector<int> of_group_;  // place in vehicles_ by group; -1: none
  bool places_known_ = false;  // of_group_ is that of vehicles_
  std::vector<char> acted_;    // by place in vehicles_: act_of() was called in this step
  std::optional<FirstFailure> failure_;
  bool some_fresh_ = false;
};

}  // namespace sim
