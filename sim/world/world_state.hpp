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
struct WorldParts;

/// The state of a world: hashed, saved and restored.  World::state() is the one of a world.
class WorldState {
 public:
  /// All must outlive this.
  WorldState(WorldParts& parts, WorldBuilder& builder, Stage& stage, WorldJournal& journal)
      : parts_(parts), builder_(builder), stage_(stage), journal_(journal) {}

  /// A hash over the whole state: bodies, joints, devices, clocks, medium, events, sound in flight, script.
  std::uint64_t hash() const;
  /// A hash over the whole way here: every message that devices and events have published, the motion of every body
  /// after each step, the whole state after every tenth step and now.  Equal ones prove equal runs, equal state hashes
  /// only equal ends.  What is published for observation alone does not count; see RunHash.  A snapshot holds it.
  std::uint64_t run_hash() const;
  /// The state hash by part, in an order that does not change: `world`, `medium`, vehicles such as `auv1`, devices such
  /// as `auv1/dvl`, `objects`, `events`, `acoustics`, `script`.
  std::vector<PartHash> part_hashes() const;
  /// All of the state between two steps, and what was added, removed and changed since the start.  Throws
  /// SnapshotError when a vehicle or object was added that was not read from YAML.
  Bytes snapshot() const;
  /// Goes to a snapshot of a world of the same configuration, of this one or of another process, and on from there
  /// with the same bits.  When vehicles, objects or the parameters of devices are not those of the snapshot, the
  /// world is rebuilt in place: references to vehicles, bodies, devices and scene become invalid, and
  /// World::generation() increases; references to World and PhysicsWorld stay valid.  Throws SnapshotError when it
  /// does not fit; the world is then as before, or, when that fails too, the error says so.  The world may have been
  /// rebuilt meanwhile: see World::generation().
  void restore(std::span<const std::byte> snapshot);

 private:
  void load(std::span<const std::byte> snapshot);

  WorldParts& parts_;
  WorldBuilder& builder_;
  Stage& stage_;
  WorldJournal& journal_;
  mutable std::size_t last_bytes_ = 0;  // of a snapshot: about what the next one needs
};

}  // namespace sim
