// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/step_schedule.hpp"

#include <optional>

#include "sim/medium/medium.hpp"
#include "sim/scene/scene.hpp"
#include "sim/vehicle/device_table.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/vehicle/step_clock.hpp"

namespace sim {

void StepSchedule::use_threads(int threads) {
  threads_ = threads == 1 ? nullptr : std::make_unique<ThreadPool>(threads);
}

void StepSchedule::clear() {
  due_.clear();
  casting_.clear();
  listening_.clear();
  acting_.clear();
  sensing_.clear();
  clocked_.clear();
}

void StepSchedule::sort(const Entities& entities, DeviceTable& devices) {
  listening_.clear();
  acting_.clear();
  sensing_.clear();
  clocked_.clear();
  for (const auto& vehicle : entities.vehicles())
    if (!vehicle->clock().perfect()) clocked_.push_back(vehicle.get());
  for (const auto& device : devices.all()) {
    if (!device) continue;
    if (device->mailbox()) listening_.push_back({devices.arrival_flag(device->number()), device.get()});
    if (device->acting()->actuator != nullptr) acting_.push_back(device->acting());
    if (device->senses())
      sensing_.push_back({device->next_sample_step(), device.get(), device->casts_rays(), device->sweeps()});
  }
}

void StepSchedule::plan_again(const MountedDevice& device) {
  for (Sensing& sensing : sensing_)
    if (sensing.device == &device) sensing.due_step = device.next_sample_step();
}

void StepSchedule::take_messages(const StepClock& clock) {
  for (const Listening& listening : listening_)
    if (listening.messages->load(std::memory_order_relaxed) &&
        listening.messages->exchange(false, std::memory_order_acquire))
      listening.device->take_messages(clock.now(), clock.step_number);
}

void StepSchedule::act(const StepClock& clock, double step_s) {
  for (Acting* acting : acting_) acting->act(clock.now(), step_s);
}

void StepSchedule::advance_clocks(const StepClock& clock, const Medium& medium) {
  for (Vehicle* vehicle : clocked_) {
    std::optional<double> temperature_C;
    if (vehicle->clock().wants_temperature(clock.now())) {
      const Vector3d p_W = vehicle->X_WV().translation();
      if (medium.in_water(p_W)) temperature_C = medium.temperature_C(p_W);
    }
    vehicle->clock().advance_to(clock.now(), temperature_C);
  }
}

/// Samples and publishes.  Sensors that cast rays take nearly all the time and change only their own state: they sample
/// first, in parallel.  All reports are then published in device order, as if the devices had sampled sequentially.
void StepSchedule::sense(const StepClock& clock, const Scene& scene) {
  due_.clear();
  casting_.clear();
  for (Sensing& sensing : sensing_) {
    const bool due = clock.step_number >= sensing.due_step;
    if (due) due_.push_back(&sensing);
    if (sensing.casts_rays && (due || sensing.sweeps)) casting_.push_back({sensing.device, due});
  }
  if (!casting_.empty()) cast_rays(clock, scene);
  for (Sensing* sensing : due_) {
    if (!sensing->casts_rays) sensing->device->sample(clock.now(), clock.step_number);
    sensing->due_step = sensing->device->next_sample_step();
    sensing->device->publish_reports();
  }
  samples_ += static_cast<std::int64_t>(due_.size());
}

void StepSchedule::cast_rays(const StepClock& clock, const Scene& scene) {
  const auto sample = [&](const Casting& casting) {
    if (casting.device->sweeps()) casting.device->sweep(clock.now());
    if (casting.due) casting.device->sample(clock.now(), clock.step_number);
  };
  // Waking threads costs as much as several hundred rays.
  constexpr std::int64_t min_rays_for_threads = 1500;
  std::int64_t rays = 0;
  for (const Casting& casting : casting_) rays += casting.device->rays();
  // When no rays are cast, as between the images of cameras, skip the look-up as well.
  if (rays > 0) scene.prepare();
  if (threads_ && rays >= min_rays_for_threads && scene.concurrent())
    threads_->for_each(casting_.size(), [&](std::size_t i) { sample(casting_[i]); });
  else
    for (const Casting& casting : casting_) sample(casting);
}

}  // namespace sim
