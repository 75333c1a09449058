// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/step_hash.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "sim/base/state_hash.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/world/world_parts.hpp"

namespace sim {

namespace {

constexpr std::size_t block = 32;  ///< bodies or vehicles

/// Motion of a body, without padding.
struct MotionBits {
  double R_WB[9], p_WB[3], v_WB_W[3], w_WB_W[3];
};

void copy(const BodyMotion& motion, MotionBits& bits) {
  std::memcpy(bits.R_WB, motion.R_WB.data(), sizeof bits.R_WB);
  std::memcpy(bits.p_WB, motion.p_WB.data(), sizeof bits.p_WB);
  std::memcpy(bits.v_WB_W, motion.v_WB_W.data(), sizeof bits.v_WB_W);
  std::memcpy(bits.w_WB_W, motion.w_WB_W.data(), sizeof bits.w_WB_W);
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
    MotionBits motions[block];
    std::size_t moving = 0;
    for (std::size_t i = begin; i < end; ++i)
      if (bodies[i] && !bodies[i]->fixed()) copy(bodies[i]->motion(), motions[moving++]);
    StateHash hash;
    hash.add_bytes(motions, moving * sizeof motions[0]);
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
      for (MountedDevice* device : vehicles[i]->devices()) of_block.add(of_device(*device));
    }
    return of_block.value();
  }));
  StateArchive rest = StateArchive::quick_hasher();
  parts.visit_beginning(rest);
  parts.visit_rest(rest);
  hash.add(rest.hash());
  return hash.value();
}

}  // namespace sim
