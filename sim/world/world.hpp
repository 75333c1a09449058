// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/base/geodesy.hpp"
#include "sim/bus/bus.hpp"
#include "sim/bus/byte_port.hpp"
#include "sim/hydrodynamics/hydrodynamics.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/vehicle/end_of_run.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/vehicle/step_clock.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/vehicle/world_buses.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

class AcousticChannel;
class StageClock;
class WorldBuilder;
class WorldEditor;
class WorldJournal;
class WorldObserver;
class WorldState;
struct WorldParts;
struct ZoneRecord;

/// Counts of a world; equal in every run.
struct WorldCounts {
  std::int64_t samples = 0;
  std::int64_t bad_messages = 0;
};

/// Simulated world: bodies, vehicles, devices and the events between them.  Advances on request, independently of wall
/// time.  It is changed through editor(), and hashed, saved and restored through state().
class World {
 public:
  /// `config` must outlive the world.  `open_port` opens the ports of devices with a pseudo-terminal or FIFO.  Throws
  /// ConfigError for errors that only construction can detect (mesh files, masses).  `find_bus` returns the bus of a
  /// name in `config.buses`; without it all vehicles are on `bus`.
  World(const WorldConfig& config, Bus& bus, PortOpener open_port = {}, BusFinder find_bus = {});
  World(const WorldConfig&&, Bus&, PortOpener = {}, BusFinder = {}) = delete;  // a temporary does not outlive it
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Sets the number of threads of a step; 0: one for each processor.  Results do not depend on it.
  void use_threads(int threads);
  /// Sets the observer of sounds and occurrences, which must outlive the world or be removed by null.  Results do not
  /// depend on it.
  void set_observer(WorldObserver* observer);

  /// Runs stages 1 to 7 of a step: messages, act, medium, script, physics, sense, report.  Throws PhysicsFault.
  void step();

  /// Returns the editor, which adds, removes, moves and changes entities of the world.
  WorldEditor& editor() { return *editor_; }
  /// Returns the state, for hashes and snapshots.
  WorldState& state() { return *state_; }
  const WorldState& state() const { return *state_; }

  std::int64_t step_number() const { return clock_.step_number; }
  Time now() const { return clock_.now(); }
  Time step_time() const { return clock_.step; }
  std::int64_t epoch_us() const { return config_.epoch_us; }
  const WorldConfig& config() const { return config_; }
  std::uint64_t seed() const { return static_cast<std::uint64_t>(config_.run.seed); }

  PhysicsWorld& physics() { return physics_; }
  const PhysicsWorld& physics() const { return physics_; }
  const Scene& scene() const { return physics_.scene(); }
  /// Returns water and air at the time of the world: in stages 1 to 5 at the start of the step, then at its end.
  const Medium& medium() const { return medium_; }
  const Hydrodynamics& hydrodynamics() const;
  /// Returns the acoustic channel between transducers.
  AcousticChannel& acoustics();
  const AcousticChannel& acoustics() const;
  const Geodesy& geodesy() const { return geodesy_; }

  std::span<const std::unique_ptr<Vehicle>> vehicles() const { return entities_.vehicles(); }
  /// Returns a vehicle by name; null when there is none.
  const Vehicle* find_vehicle(const std::string& name) const { return entities_.find_vehicle(name); }
  /// Returns the devices in the order of their numbers; null where a device was removed.
  std::span<const std::unique_ptr<MountedDevice>> devices() const;
  /// Returns a device by vehicle and device name, such as `auv1/imu`; null when there is none.
  MountedDevice* find_device(const std::string& full_name) const { return entities_.find_device(full_name); }
  /// Returns an object by name; null when there is none.
  const WorldObject* find_object(const std::string& name) const { return entities_.find_object(name); }
  /// Returns the objects by name.
  const std::map<std::string, WorldObject, std::less<>>& objects() const { return entities_.objects(); }
  /// Returns a counter of added and removed vehicles and objects: when it changes, holders of pointers to them must
  /// look them up again.
  std::uint64_t generation() const { return entities_.generation(); }
  /// Returns the objects shared by devices of one kind, such as the network between radio modems.
  const SharedByDevices& shared() const;

  /// Returns the bus of the world.
  Bus& bus();
  /// Returns the bus of a channel: that of the vehicle whose device uses it, else that of the world.
  Bus& bus_of_channel(const std::string& channel);
  WorldWarnings& warnings();
  const WorldWarnings& warnings() const;

  /// Returns reason and result when the world itself ends the run; none: it continues.
  const std::optional<EndOfRun>& ended() const;
  const Zones& zones() const;
  /// Returns the records by vehicle, when the world has zones with a speed limit or a finish.
  const std::map<std::string, ZoneRecord>& zone_records() const;
  /// Returns the number of firings of an event by name; none when it does not exist.
  std::optional<std::int64_t> event_firings(const std::string& name) const;
  WorldCounts counts() const;

 private:
  void act_in_water(StageClock& stages);
  void run_due_events();
  void add_to_run_hash();

  const WorldConfig& config_;
  const std::unique_ptr<WorldParts> parts_;
  // Parts that are used often; their addresses are stable.
  const StepClock& clock_;
  const Geodesy& geodesy_;
  PhysicsWorld& physics_;
  const Medium& medium_;
  const Entities& entities_;
  const std::unique_ptr<WorldBuilder> builder_;
  const std::unique_ptr<WorldJournal> journal_;
  const std::unique_ptr<WorldEditor> editor_;
  const std::unique_ptr<WorldState> state_;
};

}  // namespace sim
