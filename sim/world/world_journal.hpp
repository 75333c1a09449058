// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/world/journal_entry.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

class Vehicle;
struct WorldObject;
struct WorldParts;

/// Journal of the differences between a world and its configuration: vehicles and objects that were added or removed,
/// and changed parameters of devices.  A snapshot contains it, so that a world of the same configuration can be rebuilt
/// with the same structure, numbers and order.  The order matters: ODE processes bodies and joints in the order of
/// their creation. It holds the present added entities with their numbers and the latest changed values and poses;
/// entries of entities that were removed again are dropped.  Removed entities of the world file are recorded as
/// removed.  Its size therefore depends on the number of entities, not on time.  Beyond max_bytes it drops everything,
/// and gap() returns the reason.
class WorldJournal {
 public:
  /// `parts` must outlive this.
  explicit WorldJournal(const WorldParts& parts) : parts_(parts) {}

  /// Limit of the size: each snapshot contains the whole journal.
  static constexpr std::size_t max_bytes = 16 << 20;
  using Entry = JournalEntry;
  /// YAML texts with the numbers by which entries refer to them.
  using Texts = std::vector<std::pair<std::int64_t, std::string>>;

  // After each change.  `new_surfaces`: the vehicle had surfaces that were not known before.
  void vehicle_added(const VehicleInstance& instance, const Vehicle& vehicle, bool new_surfaces);
  /// Records a vehicle that could not be added but whose surfaces remain.
  void vehicle_failed(const VehicleInstance& instance, bool new_surfaces);
  void vehicle_removed(const std::string& name);
  void object_added(const ObjectConfig& config, const WorldObject& object, const Pose& X_WE);
  void object_removed(const std::string& name);
  void device_changed(const std::string& full_name, const ConfigNode& values);
  /// Records the move of a vehicle or an object that is joined to the world: its joints were created again.
  void anchored_moved(const std::string& name, int group);

  /// Returns the whole journal, as read by JournalReplay.
  Bytes bytes() const;
  /// Returns the reason why the journal is unusable; empty: it is usable.
  const std::string& gap() const { return gap_; }
  /// Drops everything and starts with the texts of another journal, whose entries are then appended one by one.  Throws
  /// SnapshotError.
  void start_again(const Texts& texts);
  void append(Entry entry);
  /// Returns a text by number.  Throws SnapshotError when there is none.
  const std::string& text(std::int64_t number) const;

 private:
  struct Text {
    std::string text;
    std::int64_t users = 0;  ///< number of entries that refer to it
  };

  Entry entry(Entry::Kind kind, const std::string& name) const;
  void drop(std::size_t place);
  /// Returns the entry that added an entity last; none: it is from the world file.
  std::optional<std::size_t> place_of(Entry::Kind kind, const std::string& name) const;
  /// Drops the changes of an existing entity, from entry `first` on.
  void drop_changes_of(const std::string& name, std::size_t first);
  void note_source(Entry& entry, const ConfigNode& source);
  void note_vehicle(Entry& entry, const VehicleInstance& instance);
  void use_text(std::int64_t number);
  void release_text(std::int64_t number);
  void check_size();
  void discard();

  const WorldParts& parts_;
  std::vector<Entry> entries_;
  std::map<std::int64_t, Text> texts_;
  std::map<std::string, std::int64_t> text_numbers_;
  std::size_t size_ = 0;
  std::string gap_;
  bool full_ = false;
};

}  // namespace sim
