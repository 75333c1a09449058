// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>

#include "sim/base/math.hpp"
#include "sim/bus/bus.hpp"

namespace sim {

class Diagnostics;
class Mechanism;
class MountedDevice;
class Vehicle;
struct ConfigNode;
struct DeviceConfig;
struct MechanismConfig;
struct ObjectConfig;
struct VehicleConfig;
struct VehicleInstance;
struct WorldObject;
struct WorldParts;

/// Builds and dismantles the entities of a world.  Records nothing in the journal.
class WorldBuilder {
 public:
  /// `parts` must outlive this, with physics and medium in their initial state.
  explicit WorldBuilder(WorldParts& parts);

  /// Builds everything in the world file except its script.  Throws ConfigError.
  void build();
  /// Removes all entities and the script, and builds the world again.
  void rebuild();

  /// Builds a vehicle; schedule() must follow.  Throws ConfigError; the world is then unchanged.
  Vehicle& build_vehicle(const VehicleInstance& instance);
  /// Builds an object; one that an actor moves becomes kinematic.  Throws ConfigError; the world is then unchanged.
  const WorldObject& place_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE);
  void dismantle(Vehicle& vehicle);
  void dismantle(const WorldObject& object);
  /// See WorldEditor::change_device.
  bool change_device(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics);
  /// Adds the devices of a vehicle to the schedule of a step.
  void schedule(Vehicle& vehicle);
  /// Rebuilds the schedule of a step, with all devices.
  void sort_devices();

 private:
  void add_objects();
  void add_vehicles();
  const WorldObject& build_object(std::shared_ptr<const ObjectConfig> config, const std::string& name,
                                  const Pose& X_WE);
  void build_parts_of(Vehicle& vehicle, const VehicleInstance& instance);
  void build_bodies_of(Mechanism& owner, const MechanismConfig& config, const Pose& X_WV, bool fixed);
  void build_joints_of(Mechanism& owner, const MechanismConfig& config, const Pose& X_WV);
  void add_device(Vehicle& vehicle, const DeviceConfig& config);
  void remove_device(const MountedDevice& device);
  void dismantle_all();

  WorldParts& parts_;
  std::map<const VehicleConfig*, int> built_of_kind_;  // only for WorldConfig::bodies_only_of_many
  Bytes medium_at_start_;
};

}  // namespace sim
