// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "sim/base/math.hpp"
#include "sim/bus/bus.hpp"
#include "sim/director/stage.hpp"
#include "sim/director/world_observer.hpp"
#include "sim/vehicle/end_of_run.hpp"
#include "sim/vehicle/entities.hpp"

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

/// Editor of a running world: adds, removes and moves vehicles and objects, sets faults and parameters of devices. Must
/// be called between steps, or from a script in stage 4 of a step.  Records what a snapshot needs to repeat the
/// changes.  World::editor() returns the editor of a world.
class WorldEditor final : public Stage {
 public:
  /// All must outlive this.
  WorldEditor(const World& world, WorldParts& parts, WorldBuilder& builder, WorldJournal& journal)
      : world_(world), parts_(parts), builder_(builder), journal_(journal) {}

  // Interface for scripts.
  const WorldConfig& config() const override;
  const StepClock& clock() const override;
  const Entities& entities() const override;
  PhysicsWorld& physics() override;
  Bus& bus_of_channel(const std::string& channel) override;
  WorldWarnings& warnings() override;
  WorldObserver* observer() const override;

  /// Adds a vehicle.  Throws ConfigError (names and channels in use, meshes, masses, limits, contacts that
  /// would change the surfaces of others, an occupied place); the vehicle is then not added.
  const Vehicle& add_vehicle(const VehicleInstance& instance);
  void remove_vehicle(const std::string& name) override;
  /// Throws the WorldError that remove_vehicle would throw.
  void check_removable(const std::string& vehicle) const;
  void move_vehicle(const std::string& name, const Pose& X_WV) override;
  const WorldObject& add_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE) override;
  void remove_object(const std::string& name) override;
  void move_object(const std::string& name, const Pose& X_WE) override;
  void set_fault(const std::string& device, const FaultConfig& fault) override;
  void clear_faults(const std::string& device) override;
  bool change_device(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics) override;
  void set_gravity(double gravity_mps2) override;
  void publish(const std::string& channel, std::span<const std::byte> payload) override;
  void end(const EndOfRun& end) override;
  /// Executes one action (a map) or several (a list of maps), as in `events:`.  Throws ConfigError.
  void run_action(const ConfigNode& action);

 private:
  void report(Occurrence::Kind kind, const std::string& who, const std::string& text = "") const;
  void check_new_vehicle(const VehicleInstance& instance) const;
  void check_place_is_free(Vehicle& vehicle, const VehicleInstance& instance);

  const World& world_;
  WorldParts& parts_;
  WorldBuilder& builder_;
  WorldJournal& journal_;
};

}  // namespace sim
