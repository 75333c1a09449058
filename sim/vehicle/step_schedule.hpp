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

/// The devices that each stage of a step visits, in device order.
class StepSchedule {
 public:
  /// Threads that share the sensors which cast rays; 0: one for each processor.  The run is the same for any number.
  void use_threads(int threads);
  /// To be called whenever devices were added or removed, or their samples are due at other times.
  void sort(const Entities& entities, DeviceTable& devices);
  void clear();
  /// A device samples at other times from now on.
  void plan_again(const MountedDevice& device);

  void take_messages(const StepClock& clock);
  void act(const StepClock& clock, double step_s);
  /// Clocks that are not perfect: before what is due, so that what is stamped in a step is stamped by the clocks as
  /// they stand at its end.
  void advance_clocks(const StepClock& clock, const Medium& medium);
  /// Stages 6 and 7.
  void sense(const StepClock& clock, const Scene& scene);
  /// Of all sensors so far.
  std::int64_t& samples() { return samples_; }

 private:
  /// A device with a mailbox, and whether there may be something in it.
  struct Listening {
    std::atomic<bool>* messages;
    MountedDevice* device;
  };
  /// A sensor, and the step after which it samples next.
  struct Sensing {
    std::int64_t due_step;
    MountedDevice* device;
    bool casts_rays, sweeps;
  };
  /// What this step has to sense.
  struct Casting {
    MountedDevice* device;
    bool due;
  };
  void cast_rays(const StepClock& clock, const Scene& scene);

  std::vector<Listening> listening_;
  std::vector<Acting*> acting_;
  std::vector<Sensing> sensing_;
  std::vector<Vehicle*> clocked_;  // vehicles whose clocks are not perfect
  std::vector<Sensing*> due_;
  std::vector<Casting> casting_;
  std::unique_ptr<ThreadPool> threads_;  // null: one thread
  std::int64_t samples_ = 0;
};

}  // namespace sim
