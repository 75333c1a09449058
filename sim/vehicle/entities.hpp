// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"
#include "sim/model/object_config.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace sim {

/// Object without devices in the world.
struct WorldObject : Mechanism {
  WorldObject(std::int64_t number_, std::string name_, int group, std::shared_ptr<const ObjectConfig> config_)
      : Mechanism(group, *config_), number(number_), name(std::move(name_)), config(std::move(config_)) {}

  std::int64_t number;  ///< increases from object to object, and is never reused
  std::string name;
  std::shared_ptr<const ObjectConfig> config;  ///< shared by the objects of a `count`
};

/// Vehicles and objects of a world, by name.
class Entities {
 public:
  const std::vector<std::unique_ptr<Vehicle>>& vehicles() const { return vehicles_; }
  const std::map<std::string, WorldObject, std::less<>>& objects() const { return objects_; }
  /// Return the entity of this name; null when there is none.
  Vehicle* find_vehicle(const std::string& name) const;
  const WorldObject* find_object(const std::string& name) const;
  MountedDevice* find_device(const std::string& full_name) const;
  /// Return the entity of this name.  Throw WorldError when there is none.
  Vehicle& vehicle_named(const std::string& name) const;
  const WorldObject& object_named(const std::string& name) const;
  MountedDevice& device_named(const std::string& full_name) const;
  /// Throws ConfigError when the name is in use.
  void check_new_name(const std::string& name, const SourcePlace& place, const std::string& who) const;

  Vehicle& add(std::unique_ptr<Vehicle> vehicle);
  const WorldObject& add(WorldObject object);
  void remove(const Vehicle& vehicle);
  void remove(const WorldObject& object);
  void clear();

  /// Return the number of the next entity that is added.
  int next_vehicle_number() const { return next_vehicle_number_; }
  std::int64_t next_object_number() const { return next_object_number_; }
  int take_vehicle_number() { return next_vehicle_number_++; }
  std::int64_t take_object_number() { return next_object_number_++; }
  /// Set the next number, for the reconstruction of a world from its journal.
  void prescribe_vehicle_number(int number) { next_vehicle_number_ = number; }
  void prescribe_object_number(std::int64_t number) { next_object_number_ = number; }

  /// Returns a counter that mark_changed() increments: with every vehicle or object that was added or removed.
  std::uint64_t generation() const { return generation_; }
  void mark_changed() { ++generation_; }
  /// Visits the next numbers.
  void visit_state(StateArchive& archive);

 private:
  std::vector<std::unique_ptr<Vehicle>> vehicles_;
  std::map<std::string, Vehicle*, std::less<>> vehicles_by_name_;
  std::map<std::string, WorldObject, std::less<>> objects_;
  int next_vehicle_number_ = 0;
  std::int64_t next_object_number_ = 0;
  std::uint64_t generation_ = 0;
};

/// Failure of an operation that the present state of the world does not allow.  what() is one line with who, rule and
/// value.
class WorldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns a name in quotes, printable and shortened, for messages.
inline std::string shown_name(const std::string& name) {
  return "'" + shortened(printable(name)) + "'";
}

/// Throws ConfigError when `count` exceeds the limit of the world.
inline void check_limit(const char* what, std::size_t count, int limit, const SourcePlace& place,
                        const std::string& who) {
  if (count > static_cast<std::size_t>(limit))
    throw_config_error(place, who,
                       "at most " + std::to_string(limit) + " " + what + " are allowed (limits of the world), got " +
                           std::to_string(count));
}

}  // namespace sim
