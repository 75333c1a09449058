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

/// The differences between a world and its configuration: vehicles and objects that were added or removed, devices
/// that got other values.  A snapshot carries it, so that a world of the same configuration can be given the same
/// structure, with the same numbers and in the same order.  The order matters: ODE processes bodies and joints in the
/// order of their creation.
///
/// It holds the present entities with their numbers, nothing that was removed again, and the latest of changed values
/// and poses.  Of what the world file has it notes that it was removed.  So it grows with what is there,
/// not with time.  Beyond max_bytes it drops everything, and gap() says so.
class WorldJournal {
 public:
  /// `parts` must outlive this.
  explicit WorldJournal(const WorldParts& parts) : parts_(parts) {}

  /// Each snapshot carries it all.
  static constexpr std::size_t max_bytes = 16 << 20;
  using Entry = JournalEntry;
  /// YAML by the numbers that entries have of it.
  using Texts = std::vector<std::pair<std::int64_t, std::string>>;

  // After each change.  `new_surfaces`: the vehicle had surfaces that were not known before.
  void vehicle_added(const VehicleInstance& instance, const Vehicle& vehicle, bool new_surfaces);
  /// One that could not be added has left its surfaces behind.
  void vehicle_failed(const VehicleInstance& instance, bool new_surfaces);
  void vehicle_removed(const std::string& name);
  void object_added(const ObjectConfig& config, const WorldObject& object, const Pose& X_WE);
  void object_removed(const std::string& name);
  void device_changed(const std::string& full_name, const ConfigNode& values);
  /// One that is joined to the world: its joints were made again.
  void anchored_vehicle_moved(const Vehicle& vehicle);

  /// All of it, as JournalReplay takes it.
  Bytes bytes() const;
  /// Why it cannot be used; empty: it can.
  const std::string& gap() const { return gap_; }
  /// Drops everything; then come the texts and, one by one, the entries of another journal.  Throws SnapshotError.
  void start_again(const Texts& texts);
  void append(Entry entry);
  /// Throws SnapshotError when there is none of this number.
  const std::string& text(std::int64_t number) const;

 private:
  struct Text {
    std::string text;
    std::int64_t users = 0;  ///< entries
  };

  Entry entry(Entry::Kind kind, const std::string& name) const;
  void drop(std::size_t place);
  /// Where something was added last; nothing: with the world file.
  std::optional<std::size_t> place_of(Entry::Kind kind, const std::string& name) const;
  /// Drops what happened to something that is there, from an entry on.
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
