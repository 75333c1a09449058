#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/math.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/world/world_config.hpp"

namespace sim {

class World;

/// What changed the make of a world since its start: what came and went, and which devices got other values.  A
/// snapshot carries it, so that a world of the same configuration can be brought to the same make, with the same
/// numbers and in the same order.  The order counts: ODE goes through bodies and joints as they came.
///
/// It does not grow with what leaves no trace: who came and went with nobody coming in between, those who could not
/// come, values of a device that were changed again.  It grows with what comes and goes in turns, so that always some
/// of it is there, and with moves of what is joined to the world: beyond most_bytes the journal lets go of everything,
/// and gap() says so.
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
  /// One that could not come has left its surfaces behind, and has used numbers.
  void vehicle_failed(const VehicleInstance& instance, bool new_surfaces);
  void vehicle_went(const std::string& name);
  void object_came(const ObjectConfig& config, const std::string& name, const Pose& X_WE, std::int64_t number);
  void object_went(const std::string& name);
  void device_changed(const std::string& full_name, const ConfigNode& values);
  /// One that is joined to the world: its joints were made anew.
  void anchored_vehicle_moved(const std::string& name, const Pose& X_move_W);

  /// All of it, as replay() takes it.
  const Bytes& bytes() const { return bytes_; }
  /// Why it cannot be told; empty: it can.
  const std::string& gap() const { return gap_; }
  /// Does it all again, in a world that was just built.  Nothing in it may be later than `last_step`.  Throws
  /// SnapshotError.
  void replay(std::span<const std::byte> bytes, std::int64_t last_step);

 private:
  enum class Kind {
    text,
    vehicle_came,
    vehicle_went,
    object_came,
    object_went,
    device_changed,
    moved,
    surfaces,  ///< of a vehicle that could not come, or went again
    numbers    ///< of devices: which are free, in their order
  };
  struct Entry {
    Kind kind = Kind::text;
    std::int64_t step = 0;
    std::string name;
    std::string text;           ///< YAML, of kind text and device_changed
    std::int64_t in_file = -1;  ///< place in the lists of the world file, for what was read there
    std::int64_t text_number = -1;
    std::string bus;
    Pose X_W = Pose::Identity();
    std::int64_t number = 0;    ///< of a text too
    bool new_surfaces = false;  ///< a vehicle brought some
    std::vector<int> free_numbers;
    std::int64_t devices = 0;
    void visit_state(StateArchive& archive);
  };

  Entry entry(Kind kind, const std::string& name) const;
  void append(Entry entry);
  /// Drops the entries of a name, from the entry `first` on, and those of its devices.
  void drop_all_of(const std::string& name, std::size_t first);
  void drop(std::size_t number);
  /// Where something came, when nobody else has come since; else nothing.
  std::optional<std::size_t> came_last(Kind kind, const std::string& name) const;
  // What a vehicle that is not there has left behind.
  void note_numbers();
  void note_surfaces(const std::string& name, std::int64_t text_number);
  /// Drops texts that no entry needs any more.
  void drop_unused_texts();
  void note_vehicle(Entry& entry, const VehicleInstance& instance);
  /// The number of a text, which is noted when it is new.
  std::int64_t number_of(const std::string& text);
  void apply(const Entry& entry);
  void apply_vehicle(const Entry& entry);
  void apply_numbers(const Entry& entry);
  void apply_object(const Entry& entry);
  const ConfigNode& parsed(std::int64_t text_number);
  std::shared_ptr<const VehicleConfig> vehicle_config(const Entry& entry);
  ObjectConfig object_config(const Entry& entry);

  World& world_;
  Bytes bytes_;
  /// An entry in bytes_, with what decides whether it still counts.
  struct Noted {
    Kind kind;
    std::string name;
    std::string text;  ///< of the values of a device; of YAML
    std::int64_t text_number;
    bool new_surfaces;
    std::size_t bytes;
  };
  std::vector<Noted> noted_;
  std::map<std::string, std::int64_t> texts_;
  std::string gap_;
  bool full_ = false;
  // While it replays.
  std::map<std::int64_t, std::string> known_texts_;
  std::map<std::int64_t, ConfigNode> parsed_;
  std::map<std::int64_t, std::shared_ptr<const VehicleConfig>> vehicles_;
};

}  // namespace sim
