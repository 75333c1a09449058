// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/step_hash.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <iterator>

#include "sim/base/record_hash.hpp"
#include "sim/base/state_hash.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/device/device.hpp"
#include "sim/world/world_parts.hpp"

namespace sim {

namespace {

constexpr std::size_t block = 32;  ///< bodies or vehicles

/// Hash of a motion.
std::uint64_t motion_hash(const BodyMotion& motion) {
  const double* const parts[] = {motion.R_WB.data(), motion.R_WB.data() + 3, motion.R_WB.data() + 6,
                                 motion.p_WB.data(), motion.v_WB_W.data(),   motion.w_WB_W.data()};
  std::uint64_t words[3 * std::size(parts)];
  for (std::size_t i = 0; i < std::size(parts); ++i) std::memcpy(words + 3 * i, parts[i], 3 * sizeof words[0]);
  return product_hash(words);
}

/// Returns whether only its samples change the state of a device.
bool changed_by_samples_only(const MountedDevice& device) {
  const bool measures = device.measures_alone() || (device.casts_rays() && !device.sweeps());
  return measures && !device.every_step() && device.actuator() == nullptr && device.mailbox() == nullptr;
}

}  // namespace

/// `hash_of`: returns the hash of the objects with the numbers from `begin` to before `end`.
template <typename HashOf>
std::uint64_t StepHash::of_blocks(std::size_t count, ThreadPool* threads, const HashOf& hash_of) {
  blocks_.resize((count + block - 1) / block);
  const auto hash_block = [&](std::size_t i) { blocks_[i] = hash_of(i * block, std::min(count, (i + 1) * block)); };
  if (threads != nullptr && count >= min_shared)
    threads->for_each(blocks_.size(), hash_block);
  else
    for (std::size_t i = 0; i < blocks_.size(); ++i) hash_block(i);
  StateHash hash;
  for (const std::uint64_t each : blocks_) hash.add(each);
  return hash.value();
}

std::uint64_t StepHash::of_motion(const WorldParts& parts, ThreadPool* threads) {
  const auto bodies = parts.physics.bodies();
  return of_blocks(bodies.size(), threads, [&](std::size_t begin, std::size_t end) {
    StateHash hash;
    for (std::size_t i = begin; i < end; ++i)
      if (bodies[i] && !bodies[i]->fixed()) hash.add(motion_hash(bodies[i]->motion()));
    return hash.value();
  });
}

std::uint64_t StepHash::of_device(MountedDevice& device) {
  SensorHash& known = sensors_[static_cast<std::size_t>(device.number())];
  if (known.next_sample_step != 0 && known.next_sample_step == device.next_sample_step()) return known.hash;
  StateArchive archive = StateArchive::quick_hasher();
  archive(device);
  const std::uint64_t hash = archive.hash();
  if (changed_by_samples_only(device)) known = {device.next_sample_step(), hash};
  return hash;
}

std::uint64_t StepHash::of_state(WorldParts& parts, ThreadPool* threads) {
  const auto& vehicles = parts.entities.vehicles();
  StateHash hash;
  sensors_.resize(parts.devices.size());
  hash.add(of_blocks(vehicles.size(), threads, [&](std::size_t begin, std::size_t end) {
    StateHash of_block;
    for (std::size_t i = begin; i < end; ++i) {
      StateArchive archive = StateArchive::quick_hasher();
      parts.visit_vehicle(archive, *vehicles[i]);
      of_block.add(archive.hash());
      for (MountedDevice* device : vehicles[i]->devices())
        if (!is_unused(device->sensor())) of_block.add(of_device(*device));
    }
    return of_block.value();
  }));
  // Signals in flight and their events have hashes that are kept up to date.
  hash.add(parts.events.content_hash());
  hash.add(parts.acoustics->content_hash());
  StateArchive archive = StateArchive::quick_hasher();
  parts.visit_beginning(archive);
  for (const auto& [name, object] : parts.entities.objects()) object.visit_state(archive);
  archive(*parts.script);
  hash.add(archive.hash());
  return hash.value();
}

}  // namespace sim
