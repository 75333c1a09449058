// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/base/thread_pool.hpp"
#include "sim/base/time.hpp"

namespace sim {

class DeviceTable;
class Entities;
class Medium;
class MountedDevice;
class Scene;
class Vehicle;
struct Acting;
struct StepClock;

/// Schedule of the devices that each stage of a step visits, in device order.
class StepSchedule {
 public:
  /// Sets the number of threads for sensors that cast rays; 0: one for each processor.  Results do not depend on it.
  void use_threads(int threads);
  /// Rebuilds the schedule.  Must be called when devices were added or removed, or their sample times have changed.
  void sort(const Entities& entities, DeviceTable& devices);
  void clear();
  /// Updates the sample times of a device.
  void plan_again(const MountedDevice& device);

  void take_messages(const StepClock& clock);
  void act(const StepClock& clock, double step_s);
  /// Advances the imperfect clocks.  Called before due events and samples, so that time stamps of a step use the clocks
  /// at its end.
  void advance_clocks(const StepClock& clock, const Medium& medium);
  /// Runs stages 6 and 7: samples the sensors and publishes their reports.
  void sense(const StepClock& clock, const Scene& scene);
  /// Returns the number of samples of all sensors since the start.
  std::int64_t& samples() { return samples_; }

 private:
  /// Device with a mailbox, and the flag for possible messages.
  struct Listening {
    std::atomic<bool>* messages;
    MountedDevice* device;
  };
  /// Sensor, and the step after which it samples next.
  struct Sensing {
    std::int64_t due_step;
    MountedDevice* device;
    bool casts_rays, sweeps;
  };
  /// Sensor to run in this step.
  struct Casting {
    MountedDevice* device;
    bool due;
  };
  void cast_rays(const StepClock& clock, const Scene& scene);

  std::vector<Listening> listening_;
  std::vector<Acting*> acting_;
  std::vector<Sensing> sensing_;
  std::vector<Vehicle*> clocked_;  // vehicles with imperfect clocks
  std::vector<Sensing*> due_;
  std::vector<Casting> casting_;
  std::unique_ptr<ThreadPool> threads_;  // null: one thread
  std::int64_t samples_ = 0;
};

}  // namespace sim
