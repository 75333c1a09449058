// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sim {

class MountedDevice;
class ThreadPool;
struct WorldParts;

/// Hashes of a world after a step, for its run hash.  Threads share blocks of bodies or vehicles of a fixed size, whose
/// hashes are combined in order: the result does not depend on the number of threads.  For sources of this folder only.
class StepHash {
 public:
  /// Returns the hash of the motion of all bodies.  `threads` may be null.
  std::uint64_t of_motion(const WorldParts& parts, ThreadPool* threads);
  /// Returns the hash of the whole state.  `threads` may be null.  A sensor whose state only its samples change is
  /// visited again after its next sample, or after forget_devices().
  std::uint64_t of_state(WorldParts& parts, ThreadPool* threads);
  /// Must be called when the state of devices has changed otherwise: by a restore, a fault or a change of parameters.
  void forget_devices() { sensors_.clear(); }
  /// Must be called when the device of this number was removed.
  void drop_device(int number) {
    if (const auto at = static_cast<std::size_t>(number); at < sensors_.size()) sensors_[at] = {};
  }

 private:
  /// Hash of a sensor, until the step of its next sample; 0: unknown.
  struct SensorHash {
    std::int64_t next_sample_step = 0;
    std::uint64_t hash = 0;
  };
  std::uint64_t of_device(MountedDevice& device);
  template <typename HashOf>
  std::uint64_t of_blocks(std::size_t count, ThreadPool* threads, const HashOf& hash_of);

  std::vector<std::uint64_t> blocks_;
  std::vector<SensorHash> sensors_;  // by device number
};

}  // namespace sim
