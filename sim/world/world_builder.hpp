// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "sim/base/math.hpp"
#include "sim/bus/bus.hpp"

namespace sim {

class Diagnostics;
class MountedDevice;
class Vehicle;
struct ConfigNode;
struct DeviceConfig;
struct ObjectConfig;
struct VehicleConfig;
struct VehicleInstance;
struct WorldObject;
struct WorldParts;

/// Builds what is in a world, and takes it apart.  Notes nothing in the journal.
class WorldBuilder {
 public:
  /// `parts` must outlive this, and have its physics and medium as they begin.
  explicit WorldBuilder(WorldParts& parts);

  /// All that is in the world file, but for its script.  Throws ConfigError.
  void build();
  /// The same anew; what was in the world is gone, and so is its script.
  void rebuild();

  /// Throws ConfigError, and nothing of it stays.
  Vehicle& build_vehicle(const VehicleInstance& instance);
  /// An object that an actor moves becomes kinematic.  Throws ConfigError, and nothing of it stays.
  const WorldObject& place_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE);
  void take_apart(Vehicle& vehicle);
  void take_apart(const WorldObject& object);
  /// See WorldEditor::change_device.
  bool change_device(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics);
  /// After vehicles came or went.
  void sort_devices();

 private:
  void add_objects();
  void add_vehicles();
  const WorldObject& build_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE);
  void build_parts_of(Vehicle& vehicle, const VehicleInstance& instance);
  void build_joints_of(Vehicle& vehicle, const VehicleInstance& instance);
  void add_device(Vehicle& vehicle, const DeviceConfig& config);
  void remove_device(const MountedDevice& device);
  void take_all_apart();

  WorldParts& parts_;
  std::map<const VehicleConfig*, int> built_of_kind_;  // only for WorldConfig::bodies_only_of_many
  Bytes medium_at_start_;
};

}  // namespace sim
