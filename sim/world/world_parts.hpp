// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "sim/acoustics/channel.hpp"
#include "sim/base/geodesy.hpp"
#include "sim/director/script.hpp"
#include "sim/director/world_observer.hpp"
#include "sim/event/event_queue.hpp"
#include "sim/hydrodynamics/hydrodynamics.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/vehicle/device_host.hpp"
#include "sim/vehicle/device_table.hpp"
#include "sim/vehicle/end_of_run.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/vehicle/stage_times.hpp"
#include "sim/vehicle/step_clock.hpp"
#include "sim/vehicle/step_schedule.hpp"
#include "sim/vehicle/surfaces.hpp"
#include "sim/vehicle/world_buses.hpp"
#include "sim/vehicle/world_warnings.hpp"
#include "sim/world/step_hash.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

class World;
struct SharedWork;

/// Parts of a world.  World owns and steps them; WorldBuilder builds and dismantles the entities, WorldEditor changes
/// them, WorldState saves and restores them.  For sources of this folder only.
struct WorldParts {
  /// Makes the initial physics and medium without entities, which WorldBuilder adds.  `config` and `bus` must outlive
  /// this.
  WorldParts(const World& world, const WorldConfig& config, Bus& bus, PortOpener open_port, BusFinder find_bus);

  std::uint64_t seed() const { return static_cast<std::uint64_t>(config.run.seed); }
  /// Visits `world`, `medium`, each vehicle with its devices, `objects` and the other parts; see
  /// WorldState::part_hashes().
  void visit_state(StateArchive& archive);
  // Pieces of visit_state(): from `world` to `medium`; a vehicle without its devices; from `objects` on.
  void visit_beginning(StateArchive& archive);
  void visit_vehicle(StateArchive& archive, Vehicle& vehicle);
  void visit_rest(StateArchive& archive);

  // Members are in the order of dependence: devices are destroyed before the objects to which they refer.
  const WorldConfig& config;
  PortOpener open_port;
  StepClock clock;
  bool in_step = false;  ///< remains true after a step that threw
  Geodesy geodesy;
  WorldWarnings warnings;
  EventQueue events;
  SharedByDevices shared;
  PhysicsWorld physics;
  Medium medium;
  std::optional<Hydrodynamics> hydrodynamics;
  std::unique_ptr<AcousticChannel> acoustics;
  WorldBuses buses;
  Surfaces surfaces;
  ArrivalFlags awake;
  DeviceHost host;
  Entities entities;
  DeviceTable devices;
  StepSchedule schedule;
  StepHash step_hash;
  std::unique_ptr<Script> script;  ///< null: the world was lost in a failed restore
  std::optional<EndOfRun> ended;
  WorldObserver* observer = nullptr;  ///< null: none
  StageTimes* stage_times = nullptr;  ///< null: not measured
  SharedWork* shared_work = nullptr;  ///< null: not measured
};

}  // namespace sim
