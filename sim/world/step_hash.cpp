// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/step_hash.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <iterator>

#include "sim/base/state_hash.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/world/world_parts.hpp"

namespace sim {

namespace {

constexpr std::size_t block = 32;  ///< bodies or vehicles
constexpr std::size_t min_shared_events = 1000;

/// Keys of the words of a motion: the sequence of splitmix64.
constexpr std::size_t motion_words = 18;
constexpr std::array<std::uint64_t, motion_words> motion_keys = [] {
  std::array<std::uint64_t, motion_words> keys{};
  std::uint64_t state = 0;
  for (std::uint64_t& key : keys) {
    state += 0x9e3779b97f4a7c15ULL;
    key = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9ULL;
    key = (key ^ (key >> 27)) * 0x94d049bb133111ebULL;
    key ^= key >> 31;
  }
  return keys;
}();

/// Both halves of a product of 128 bits, folded.
std::uint64_t folded(std::uint64_t a, std::uint64_t b) {
  __extension__ using Wide = unsigned __int128;
  const Wide product = static_cast<Wide>(a) * b;
  return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

/// Hash of a motion: the sum of products of pairs of words with keys, in the manner of the hash NH (Black et al., UMAC,
/// 1999).  The products do not wait for each other, which a chain would.
std::uint64_t motion_hash(const BodyMotion& motion) {
  const double* const parts[] = {motion.R_WB.data(), motion.R_WB.data() + 3, motion.R_WB.data() + 6,
                                 motion.p_WB.data(), motion.v_WB_W.data(),   motion.w_WB_W.data()};
  std::uint64_t words[motion_words];
  for (std::size_t i = 0; i < std::size(parts); ++i) std::memcpy(words + 3 * i, parts[i], 3 * sizeof words[0]);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < motion_words; i += 2)
    sum += folded(words[i] ^ motion_keys[i], words[i + 1] ^ motion_keys[i + 1]);
  return sum;
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
      for (MountedDevice* device : vehicles[i]->devices()) of_block.add(of_device(*device));
    }
    return of_block.value();
  }));
  // The rest in parts, which threads share when much sound is in flight.
  const auto hash_part = [&parts](std::size_t part) {
    StateArchive archive = StateArchive::quick_hasher();
    if (part == 0) archive(parts.events);
    if (part == 1) archive(*parts.acoustics);
    if (part == 2) parts.visit_beginning(archive);
    if (part == 3) {
      for (const auto& [name, object] : parts.entities.objects()) archive(*object.body);
      archive(*parts.script);
    }
    return archive.hash();
  };
  std::array<std::uint64_t, 4> rest{};
  const auto hash_rest = [&](std::size_t part) { rest[part] = hash_part(part); };
  if (threads != nullptr && parts.events.size() >= min_shared_events)
    threads->for_each(rest.size(), hash_rest);
  else
    for (std::size_t part = 0; part < rest.size(); ++part) hash_rest(part);
  for (const std::uint64_t each : rest) hash.add(each);
  return hash.value();
}

}  // namespace sim
