// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/step_schedule.hpp"

#include <algorithm>
#include <optional>

#include "sim/medium/medium.hpp"
#include "sim/scene/scene.hpp"
#include "sim/vehicle/device_table.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/vehicle/stage_times.hpp"
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
  each_step_.clear();
  sweeping_.clear();
  calendar_.clear(0);
  clocked_.clear();
}

void StepSchedule::sort(const Entities& entities, DeviceTable& devices, const StepClock& clock) {
  clear();
  calendar_.clear(clock.step_number);
  for (const auto& vehicle : entities.vehicles()) {
    acting_.add(*vehicle);
    if (!vehicle->clock().perfect()) clocked_.push_back({Time{0}, vehicle.get()});
  }
  for (const auto& device : devices.all())
    if (device) add(*device, devices);
}

void StepSchedule::add(Vehicle& vehicle, DeviceTable& devices) {
  acting_.add(vehicle);
  if (!vehicle.clock().perfect()) clocked_.push_back({Time{0}, &vehicle});
  for (MountedDevice* device : vehicle.devices()) add(*device, devices);
}

void StepSchedule::remove(const Vehicle& vehicle) {
  acting_.remove(vehicle);
  std::erase_if(clocked_, [&](const Clocked& clocked) { return clocked.vehicle == &vehicle; });
  for (const MountedDevice* device : vehicle.devices()) remove(*device);
}

namespace {

void insert_number(std::vector<std::uint32_t>& ascending, std::uint32_t number) {
  ascending.insert(std::lower_bound(ascending.begin(), ascending.end(), number), number);
}

void erase_number(std::vector<std::uint32_t>& ascending, std::uint32_t number) {
  const auto at = std::lower_bound(ascending.begin(), ascending.end(), number);
  if (at != ascending.end() && *at == number) ascending.erase(at);
}

}  // namespace

void StepSchedule::add(MountedDevice& device, DeviceTable& devices) {
  const auto number = static_cast<std::uint32_t>(device.number());
  if (device.mailbox()) {
    // By number, so that messages are taken in the same order after a snapshot, whatever was added and removed before
    // it.
    const auto at = listening_.empty() || listening_.back().number < number
                        ? listening_.end()
                        : std::partition_point(listening_.begin(), listening_.end(),
                                               [&](const Listening& each) { return each.number < number; });
    listening_.insert(at, {devices.arrival_flag(device.number()), &device, number});
  }
  if (!device.senses()) return;
  if (sensing_.size() <= number) sensing_.resize(number + 1);
  sensing_[number] = {device.next_sample_step(), &device,         device.awake(),
                      device.casts_rays(),       device.sweeps(), device.measures_alone()};
  if (device.sweeps()) insert_number(sweeping_, number);
  plan(number);
}

void StepSchedule::remove(const MountedDevice& device) {
  const auto number = static_cast<std::uint32_t>(device.number());
  const auto at = std::partition_point(listening_.begin(), listening_.end(),
                                       [&](const Listening& each) { return each.number < number; });
  if (at != listening_.end() && at->device == &device) listening_.erase(at);
  if (sensing_.size() <= number || sensing_[number].device != &device) return;
  unplan(number);
  erase_number(sweeping_, number);
  sensing_[number] = {};
}

/// Enters the next sample of a sensor.
void StepSchedule::plan(std::uint32_t number) {
  Sensing& sensing = sensing_[number];
  sensing.every_step = sensing.device->every_step();
  sensing.due_step = sensing.device->next_sample_step();
  if (sensing.every_step)
    insert_number(each_step_, number);
  else
    calendar_.add(number, sensing.due_step);
}

/// Reverts plan().
void StepSchedule::unplan(std::uint32_t number) {
  const Sensing& sensing = sensing_[number];
  if (sensing.every_step)
    erase_number(each_step_, number);
  else
    calendar_.remove(number, sensing.due_step);
}

void StepSchedule::plan_again(const MountedDevice& device) {
  const auto number = static_cast<std::uint32_t>(device.number());
  if (sensing_.size() <= number || sensing_[number].device != &device) return;
  unplan(number);
  plan(number);
}

void StepSchedule::take_messages(const StepClock& clock) {
  taking_.clear();
  std::size_t alone = 0;
  // Devices mark arrivals in a flag, and the cheap load comes first: most of thousands of devices have no message in
  // a step.
  for (const Listening& listening : listening_) {
    if (!listening.messages->load(std::memory_order_relaxed) ||
        !listening.messages->exchange(false, std::memory_order_acquire))
      continue;
    taking_.push_back({listening.device, threads_ && listening.device->takes_messages_alone(), {}});
    alone += taking_.back().alone ? 1 : 0;
  }
  const auto take_alone = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (taking_[i].alone) taking_[i].device->take_messages(clock.now(), clock.step_number, &taking_[i].bad);
  };
  const bool shared = alone >= min_shared;
  // Below some number of devices starting the threads costs more than it saves. Warnings of threads are kept in `bad`
  // and given in the order of the devices.
  if (shared) for_each_block(threads_.get(), taking_.size(), take_alone);
  for (const Taking& taking : taking_)
    if (shared && taking.alone)
      taking.device->report_bad_messages(taking.bad);
    else
      taking.device->take_messages(clock.now(), clock.step_number);
}

void StepSchedule::act(const StepClock& clock, double step_s) {
  acting_.act(clock, step_s, threads_.get());
}

void StepSchedule::advance_clocks(const StepClock& clock, const Medium& medium) {
  for (Clocked& clocked : clocked_) {
    if (clock.now() < clocked.due) continue;
    VehicleClock& own = clocked.vehicle->clock();
    std::optional<double> temperature_C;
    // The temperature is costly, and only an oscillator that depends on it asks.
    if (own.wants_temperature(clock.now())) {
      const Vector3d p_W = clocked.vehicle->X_WV().translation();
      if (medium.in_water(p_W)) temperature_C = medium.temperature_C(p_W);
    }
    own.advance_to(clock.now(), temperature_C);
    clocked.due = own.next_advance();
  }
}

/// Finds the sensors that sample in this step, in device order.
void StepSchedule::find_due(std::int64_t step) {
  due_.clear();
  calendar_.take(step, due_);
  for (const std::uint32_t number : each_step_) {
    const Sensing& sensing = sensing_[number];
    if (step >= sensing.due_step && (sensing.awake == nullptr || sensing.awake->load(std::memory_order_relaxed)))
      due_.push_back(number);
  }
  std::sort(due_.begin(), due_.end());
}

/// Samples and publishes.  Sensors that cast rays take nearly all the time in many worlds and change only their own
/// state: they sample first, in parallel, with those that measure alone.  All reports are then published in device
/// order, as if the devices had sampled sequentially.
void StepSchedule::sense(const StepClock& clock, const Scene& scene, StageClock& stages) {
  find_due(clock.step_number);
  find_casting();
  const bool shared = cast_rays(clock, scene, stages);
  stages.end(StepStage::rays);
  for (std::size_t i = 0; i < due_.size(); ++i) {
    const std::uint32_t number = due_[i];
    Sensing& sensing = sensing_[number];
    if (sensing.casts_rays || (shared && sensing.alone)) {
      if (!sensing.casts_rays) deferred_[i].publish();
      sensing.device->publish_reports();
    } else {
      sensing.device->sample(clock.now(), clock.step_number, false);
    }
    if (sensing.awake == nullptr || !sensing.every_step) ++samples_;
    if (sensing.every_step) continue;
    sensing.due_step = sensing.device->next_sample_step();
    calendar_.add(number, sensing.due_step);
  }
  stages.end(StepStage::sensors);
}

/// Finds the sensors that cast rays in this step.
void StepSchedule::find_casting() {
  casting_.clear();
  for (const std::uint32_t number : due_)
    if (sensing_[number].casts_rays) casting_.push_back({sensing_[number].device, true, nullptr});
  for (const std::uint32_t number : sweeping_) {
    const Sensing& sensing = sensing_[number];
    if (sensing.casts_rays && !std::binary_search(due_.begin(), due_.end(), number))
      casting_.push_back({sensing.device, false, nullptr});
  }
}

/// Decides whether threads share the sensors of this step.  Waking threads costs as much as several hundred rays.
bool StepSchedule::shares_sensors(const Scene& scene, std::int64_t rays) const {
  if (!threads_ || threads_->threads() == 1 || !scene.concurrent()) return false;
  constexpr std::int64_t min_rays = 1500;
  if (rays >= min_rays) return true;
  std::size_t sensors = casting_.size();
  for (const std::uint32_t number : due_) sensors += sensing_[number].alone ? 1 : 0;
  return sensors >= min_shared;
}

bool StepSchedule::cast_rays(const StepClock& clock, const Scene& scene, StageClock& stages) {
  std::int64_t rays = 0;
  for (const Casting& casting : casting_) rays += casting.device->rays();
  stages.count_rays(rays);
  const bool shared = shares_sensors(scene, rays);
  if (shared) {
    if (deferred_.size() < due_.size()) deferred_.resize(due_.size());
    for (std::size_t i = 0; i < due_.size(); ++i) {
      if (!sensing_[due_[i]].alone) continue;
      casting_.push_back({sensing_[due_[i]].device, true, &deferred_[i]});
      rays += casting_.back().device->rays();
    }
  }
  const auto sample = [&](std::size_t i) {
    const Casting& casting = casting_[i];
    if (casting.messages != nullptr) {
      const DeferredMessages::InThread in_thread(*casting.messages);
      casting.device->sample(clock.now(), clock.step_number, true);
      return;
    }
    if (casting.device->sweeps()) casting.device->sweep(clock.now());
    if (casting.due) casting.device->sample(clock.now(), clock.step_number, true);
  };
  // When no rays are cast, as between the images of cameras, skip the look-up as well.
  if (rays > 0) scene.prepare();
  if (shared)
    threads_->for_each(casting_.size(), sample);
  else
    for (std::size_t i = 0; i < casting_.size(); ++i) sample(i);
  return shared;
}

}  // namespace sim
