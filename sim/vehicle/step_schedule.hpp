// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/base/thread_pool.hpp"
#include "sim/base/time.hpp"
#include "sim/vehicle/acting_vehicles.hpp"
#include "sim/vehicle/run_hash.hpp"
#include "sim/vehicle/sample_calendar.hpp"

namespace sim {

class DeviceTable;
class Entities;
class Medium;
class MountedDevice;
class Scene;
class StageClock;
class Vehicle;
struct Acting;
struct StepClock;

/// Schedule of the devices that each stage of a step visits, in device order.
class StepSchedule {
 public:
  /// Sets the number of threads that share the work of a step; 0: one for each processor.  Results do not depend on it.
  void use_threads(int threads);
  /// Returns the threads that share the work of a step; null: one thread.
  ThreadPool* threads() const { return threads_.get(); }
  /// Rebuilds the schedule.  Must be called when the sample times of devices have changed.
  void sort(const Entities& entities, DeviceTable& devices, const StepClock& clock);
  void clear();
  /// Adds the devices of a vehicle.
  void add(Vehicle& vehicle, DeviceTable& devices);
  /// Removes the devices of a vehicle, if it was added.  Call before they are destroyed.
  void remove(const Vehicle& vehicle);
  /// Updates the sample times of a device.
  void plan_again(const MountedDevice& device);

  void take_messages(const StepClock& clock);
  /// Lets the actuators act.  Vehicles whose actuators act alone are shared among threads; when several actuators
  /// throw, the exception is that of the first one in device order.
  void act(const StepClock& clock, double step_s);
  /// Returns the actuators by vehicle, for a step that lets them act group by group.
  ActingVehicles& acting() { return acting_; }
  /// Advances the imperfect clocks.  Called before due events and samples, so that time stamps of a step use the clocks
  /// at its end.
  void advance_clocks(const StepClock& clock, const Medium& medium);
  /// Runs stages 6 and 7: samples the sensors and publishes their reports.
  void sense(const StepClock& clock, const Scene& scene, StageClock& stages);
  /// Returns the number of samples of all sensors since the start, without those of sensors that sleep.
  std::int64_t& samples() { return samples_; }

 private:
  /// Device with a mailbox, and the flag for possible messages.
  struct Listening {
    std::atomic<bool>* messages;
    MountedDevice* device;
    std::uint32_t number;  // of the device
  };
  /// Device with messages to take in this step, and the errors of bad ones.
  struct Taking {
    MountedDevice* device;
    bool alone;
    std::vector<std::string> bad;
  };
  /// Sensor, and the step after which it samples next.
  struct Sensing {
    std::int64_t due_step = 0;
    MountedDevice* device = nullptr;     // null: no sensor
    std::atomic<bool>* awake = nullptr;  // null: it never sleeps
    bool casts_rays = false, sweeps = false, alone = false;
    bool every_step = false;  // as planned
  };
  /// Vehicle with an imperfect clock, and the time before which the clock needs no call.
  struct Clocked {
    Time due;
    Vehicle* vehicle;
  };
  /// Sensor to run in this step before the others.
  struct Casting {
    MountedDevice* device;
    bool due;
    DeferredMessages* messages;  // null for one that casts rays
  };
  void add(MountedDevice& device, DeviceTable& devices);
  void remove(const MountedDevice& device);
  void plan(std::uint32_t number);
  void unplan(std::uint32_t number);
  void find_due(std::int64_t step);
  void find_casting();
  bool shares_sensors(const Scene& scene, std::int64_t rays) const;
  /// Samples the sensors that cast rays, and all that measure alone if threads share them.  Returns whether they do.
  bool cast_rays(const StepClock& clock, const Scene& scene, StageClock& stages);

  std::vector<Listening> listening_;
  ActingVehicles acting_;
  std::vector<Sensing> sensing_;          // by device number; the lists below are of numbers
  std::vector<std::uint32_t> each_step_;  // sensors that sample in each step, unless they sleep; ascending
  std::vector<std::uint32_t> sweeping_;   // ascending
  SampleCalendar calendar_;               // of the others
  std::vector<Clocked> clocked_;
  std::vector<std::uint32_t> due_;
  std::vector<Casting> casting_;
  std::vector<DeferredMessages> deferred_;  // of the sensors of due_
  std::vector<Taking> taking_;
  std::unique_ptr<ThreadPool> threads_;  // null: one thread
  std::int64_t samples_ = 0;
};

}  // namespace sim
