// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "sim/base/math.hpp"
#include "sim/bus/bus.hpp"
#include "sim/vehicle/end_of_run.hpp"
#include "sim/vehicle/world_error.hpp"

namespace sim {

class Diagnostics;
class Vehicle;
class World;
class WorldBuilder;
class WorldJournal;
struct ConfigNode;
struct FaultConfig;
struct ObjectConfig;
struct VehicleInstance;
struct WorldObject;
struct WorldParts;

/// Changes a world while it runs: adds, removes and moves vehicles and objects, sets faults and values of devices. Call
/// between steps, or from a script in stage 4 of a step.  What a snapshot needs to make the same changes again is
/// noted.  World::editor() is the one of a world.
class WorldEditor {
 public:
  /// All must outlive this.
  WorldEditor(const World& world, WorldParts& parts, WorldBuilder& builder, WorldJournal& journal)
      : world_(world), parts_(parts), builder_(builder), journal_(journal) {}

  /// Adds a vehicle.  Throws ConfigError (names and channels that are taken, meshes, masses, limits, contacts that
  /// would change the surfaces of others, a place where something stands), and the vehicle is not there then.
  const Vehicle& add_vehicle(const VehicleInstance& instance);
  /// Throws WorldError when there is none, or when a metric scores it.
  void remove_vehicle(const std::string& name);
  /// Throws WorldError as remove_vehicle would.
  void check_removable(const std::string& vehicle) const;
  /// Moves all bodies of a vehicle so that its frame stands at X_WV, at rest.  Throws WorldError.
  void move_vehicle(const std::string& name, const Pose& X_WV);
  /// Adds one object (config.count is not looked at).  Throws ConfigError as add_vehicle does.
  const WorldObject& add_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE);
  /// Throws WorldError when there is none.
  void remove_object(const std::string& name);
  /// Puts an object's frame at a pose, at rest.  Throws WorldError.
  void move_object(const std::string& name, const Pose& X_WE);
  /// Throw WorldError when there is no such device, or the fault does not fit it.
  void set_fault(const std::string& device, const FaultConfig& fault);
  void clear_faults(const std::string& device);
  /// Gives a device other values while it runs.  False: `diagnostics` say why, and nothing has changed.
  bool change_device(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics);
  /// Downwards, in m/s2, from the next step on.
  void set_gravity(double gravity_mps2);
  /// Sends a message, as a script does, on the bus of the device whose channel it is, else on the world's.
  void publish(const std::string& channel, std::span<const std::byte> payload);
  /// The run ends after this step; the first call counts.
  void end(const EndOfRun& end);
  /// Carries out one action (a map) or several (a list of maps), as in `events:`.  Throws ConfigError.
  void run_action(const ConfigNode& action);

 private:
  void check_new_vehicle(const VehicleInstance& instance) const;
  void check_place_is_free(Vehicle& vehicle, const VehicleInstance& instance);

  const World& world_;
  WorldParts& parts_;
  WorldBuilder& builder_;
  WorldJournal& journal_;
};

}  // namespace sim
