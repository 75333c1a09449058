// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/bus/bus.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

class Vehicle;
class World;
struct WorldObject;

/// What makes a world another one than its configuration says: what came and went, and which devices got other values.
/// A snapshot carries it, so that a world of the same configuration can be brought to the same make, with the same
/// numbers and in the same order.  The order counts: ODE goes through bodies and joints as they came.
///
/// It tells of those who are there, with the numbers they have, and not of those who came and went again; of values and
/// places that were changed, the last ones.  Of who came from the world file it notes that they went.  So it grows with
/// what is there, not with time.  Beyond most_bytes it lets go of everything, and gap() says so.
class WorldJournal {
 public:
  explicit WorldJournal(World& world) : world_(world) {}

  /// Each snapshot carries it all.
  static constexpr std::size_t most_bytes = 16 << 20;

  /// A vehicle has materials, contacts or categories that the world does not know yet.
  bool has_new_surfaces(const VehicleConfig& config) const;
  // Called by the world for each change, after it.  `number`: that the vehicle or object got.  `new_surfaces`: what
  // has_new_surfaces() said before.
  void vehicle_came(const VehicleInstance& instance, int number, bool new_surfaces);
  /// One that could not come has left its surfaces behind.
  void vehicle_failed(const VehicleInstance& instance, bool new_surfaces);
  void vehicle_went(const std::string& name);
  void object_came(const ObjectConfig& config, const WorldObject& object, const Pose& X_WE);
  void object_went(const std::string& name);
  void device_changed(const std::string& full_name, const ConfigNode& values);
  /// One that is joined to the world: its joints were made anew.
  void anchored_vehicle_moved(const Vehicle& vehicle);

  /// All of it, as replay() takes it.
  Bytes bytes() const;
  /// Why it cannot be told; empty: it can.
  const std::string& gap() const { return gap_; }
  /// Does it all again, in a world that was just built.  Nothing in it may be later than `last_step`.  Throws
  /// SnapshotError.
  void replay(std::span<const std::byte> bytes, std::int64_t last_step);

 private:
  enum class Kind {
    vehicle_came,
    vehicle_went,  ///< one of the world file
    object_came,
    object_went,
    device_changed,
    moved,
    surfaces  ///< of a vehicle that could not come, or went again
  };
  struct Entry {
    Kind kind = Kind::surfaces;
    std::int64_t step = 0;
    std::string name;
    std::string values;         ///< of a device, YAML
    std::int64_t in_file = -1;  ///< place in the lists of the world file, for what was read there
    std::int64_t text_number = -1;
    std::string bus;
    Pose X_W = Pose::Identity();
    bool new_surfaces = false;  ///< a vehicle brought some
    std::int64_t number = 0;    ///< of the vehicle or object
    GroupNumbers numbers;
    std::vector<int> devices, transducers;  ///< their numbers
    std::vector<JointPlace> joints;         ///< of one that was moved
    void visit_state(StateArchive& archive);
    /// About.
    std::size_t bytes() const;
  };
  /// YAML that entries share.
  struct Text {
    std::string text;
    std::int64_t users = 0;  ///< entries
  };

  Entry entry(Kind kind, const std::string& name) const;
  void append(Entry entry);
  void drop(std::size_t place);
  /// Where something came last; nothing: with the world file.
  std::optional<std::size_t> place_of(Kind came, const std::string& name) const;
  /// Drops what happened to somebody who is there, from an entry on.
  void drop_changes_of(const std::string& name, std::size_t first);
  void note_source(Entry& entry, const ConfigNode& source);
  void note_vehicle(Entry& entry, const VehicleInstance& instance);
  void use_text(std::int64_t number);
  void let_go_of_text(std::int64_t number);
  void check_size();
  void forget();
  void apply(const Entry& entry);
  void apply_vehicle(const Entry& entry);
  void apply_object(const Entry& entry);
  void apply_move(const Entry& entry);
  void prescribe_devices(const Entry& entry);
  void check_prescribed() const;
  /// Which numbers of devices are free, in the order in which they will be used.
  void set_free_devices(std::vector<int> free, std::int64_t devices);
  const ConfigNode& parsed(std::int64_t text_number);
  std::shared_ptr<const VehicleConfig> vehicle_config(const Entry& entry);
  ObjectConfig object_config(const Entry& entry);

  World& world_;
  std::vector<Entry> entries_;
  std::map<std::int64_t, Text> texts_;
  std::map<std::string, std::int64_t> text_numbers_;
  std::size_t size_ = 0;
  std::string gap_;
  bool full_ = false;
  // While it replays.
  std::map<std::int64_t, ConfigNode> parsed_;
  std::map<std::int64_t, std::shared_ptr<const VehicleConfig>> vehicles_;
};

}  // namespace sim
