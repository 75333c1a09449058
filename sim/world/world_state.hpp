// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

class Stage;
class WorldBuilder;
class WorldJournal;
struct SharedWork;
struct StageTimes;
struct WorldParts;

/// Hashes, saves and restores the state of a world, and measures its steps.  World::state() returns the one of a world.
class WorldState {
 public:
  /// All must outlive this.
  WorldState(WorldParts& parts, WorldBuilder& builder, Stage& stage, WorldJournal& journal)
      : parts_(parts), builder_(builder), stage_(stage), journal_(journal) {}

  /// Returns a hash of the whole state: bodies, joints, devices, clocks, medium, events, sound in flight, script.
  std::uint64_t hash() const;
  /// Returns a hash of the whole run up to now: every message that devices and events have published, the motion of
  /// every body after each step, the whole state after every fiftieth step and now.  Equal run hashes mean equal runs;
  /// equal state hashes mean only equal final states.  Channels for observation only are excluded; see RunHash.  A
  /// snapshot contains the run hash.
  std::uint64_t run_hash() const { return run_hash(hash()); }
  /// Does the same where hash() is known.
  std::uint64_t run_hash(std::uint64_t state_hash) const;
  /// Returns the state hashes by part, in a fixed order: `world`, `medium`, vehicles such as `auv1`, devices such
  /// as `auv1/dvl`, `objects`, `events`, `acoustics`, `script`.
  std::vector<PartHash> part_hashes() const;
  /// Returns the whole state between two steps, and the entities and parameters that were added, removed or changed
  /// since the start.  Throws SnapshotError when a vehicle or object was added that was not read from YAML.
  Bytes snapshot() const;
  /// Restores a snapshot of a world of the same configuration, from this or another process; the run then continues bit
  /// by bit as from the snapshot.  When vehicles, objects or the parameters of devices are not those of the snapshot,
  /// the world is rebuilt in place: references to vehicles, bodies, devices and scene become invalid, and
  /// World::generation() increases; references to World and PhysicsWorld stay valid.  Throws SnapshotError when the
  /// snapshot does not match; the world is then as before, or, when that fails too, the error says so.  The world may
  /// have been rebuilt meanwhile: see World::generation().
  void restore(std::span<const std::byte> snapshot);
  /// Adds the time of each stage to `times` from the next step on, which must outlive the world or be removed by null.
  /// No result depends on it.
  void measure_stages(StageTimes* times);
  /// Adds the times of steps that several threads share to `work` from now on; otherwise like measure_stages().
  void measure_shared_work(SharedWork* work);

 private:
  void load(std::span<const std::byte> snapshot);

  WorldParts& parts_;
  WorldBuilder& builder_;
  Stage& stage_;
  WorldJournal& journal_;
  mutable std::size_t last_bytes_ = 0;  // size of the last snapshot, an estimate for the next one
};

}  // namespace sim
