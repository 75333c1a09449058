// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>

#include "sim/world/journal_entry.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

class WorldBuilder;
class WorldJournal;
struct WorldParts;

/// Replays the changes of a journal in a newly built world, and records them in its journal.
class JournalReplay {
 public:
  /// All must outlive this.
  JournalReplay(WorldParts& parts, WorldBuilder& builder, WorldJournal& journal)
      : parts_(parts), builder_(builder), journal_(journal) {}

  /// Replays a journal.  `bytes`: WorldJournal::bytes() of another journal, possibly untrusted.  No entry may be later
  /// than `last_step`.  Throws SnapshotError.
  void replay(std::span<const std::byte> bytes, std::int64_t last_step);

 private:
  using Entry = JournalEntry;
  void apply(const Entry& entry);
  void apply_vehicle(const Entry& entry);
  void apply_object(const Entry& entry);
  void apply_change(const Entry& entry);
  void apply_move(const Entry& entry);
  const ConfigNode& parsed(std::int64_t text_number);
  std::shared_ptr<const VehicleConfig> vehicle_config(const Entry& entry);
  ObjectConfig object_config(const Entry& entry);

  WorldParts& parts_;
  WorldBuilder& builder_;
  WorldJournal& journal_;
  std::map<std::int64_t, ConfigNode> parsed_;
  std::map<std::int64_t, std::shared_ptr<const VehicleConfig>> vehicles_;
};

}  // namespace sim
