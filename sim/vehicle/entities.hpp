// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/model/object_config.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace sim {

/// A thing without devices, as built.
struct WorldObject {
  std::int64_t number = 0;  ///< grows from object to object, and is not used again
  std::string name;
  int group = -1;
  Body* body = nullptr;
  ObjectConfig config;
};

/// The vehicles and objects of a world, by name.
class Entities {
 public:
  const std::vector<std::unique_ptr<Vehicle>>& vehicles() const { return vehicles_; }
  const std::map<std::string, WorldObject, std::less<>>& objects() const { return objects_; }
  /// Null when there is none.
  Vehicle* find_vehicle(const std::string& name) const;
  const WorldObject* find_object(const std::string& name) const;
  MountedDevice* find_device(const std::string& full_name) const;
  /// Throw WorldError when there is none.
  Vehicle& vehicle_named(const std::string& name) const;
  const WorldObject& object_named(const std::string& name) const;
  MountedDevice& device_named(const std::string& full_name) const;
  /// Throws ConfigError when something has this name.
  void check_new_name(const std::string& name, const SourcePlace& place, const std::string& who) const;

  Vehicle& add(std::unique_ptr<Vehicle> vehicle);
  const WorldObject& add(WorldObject object);
  void remove(const Vehicle& vehicle);
  void remove(const WorldObject& object);
  void clear();

  /// Of the next one that is added.
  int next_vehicle_number() const { return next_vehicle_number_; }
  std::int64_t next_object_number() const { return next_object_number_; }
  int take_vehicle_number() { return next_vehicle_number_++; }
  std::int64_t take_object_number() { return next_object_number_++; }
  /// For who builds a world again as it became.
  void prescribe_vehicle_number(int number) { next_vehicle_number_ = number; }
  void prescribe_object_number(std::int64_t number) { next_object_number_ = number; }

  /// Grows when mark_changed() is called: with every vehicle or object that was added or removed.
  std::uint64_t generation() const { return generation_; }
  void mark_changed() { ++generation_; }
  /// The next numbers.
  void visit_state(StateArchive& archive);

 private:
  std::vector<std::unique_ptr<Vehicle>> vehicles_;
  std::map<std::string, Vehicle*, std::less<>> vehicles_by_name_;
  std::map<std::string, WorldObject, std::less<>> objects_;
  int next_vehicle_number_ = 0;
  std::int64_t next_object_number_ = 0;
  std::uint64_t generation_ = 0;
};

}  // namespace sim
