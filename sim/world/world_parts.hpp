// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "sim/acoustics/channel.hpp"
#include "sim/base/geodesy.hpp"
#include "sim/director/script.hpp"
#include "sim/event/event_queue.hpp"
#include "sim/hydrodynamics/hydrodynamics.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/vehicle/device_host.hpp"
#include "sim/vehicle/device_table.hpp"
#include "sim/vehicle/end_of_run.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/vehicle/step_clock.hpp"
#include "sim/vehicle/step_schedule.hpp"
#include "sim/vehicle/surfaces.hpp"
#include "sim/vehicle/world_buses.hpp"
#include "sim/vehicle/world_warnings.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

class World;

/// What a world is made of.  World owns it; WorldBuilder fills and empties it, World steps it, WorldEditor changes it,
/// WorldState saves and restores it.  For sources of this folder only.
struct WorldParts {
  /// `config` and `bus` must outlive this.  Initial physics and medium, without content: WorldBuilder adds it.
  WorldParts(const World& world, const WorldConfig& config, Bus& bus, PortOpener open_port, BusFinder find_bus);

  std::uint64_t seed() const { return static_cast<std::uint64_t>(config.run.seed); }
  /// `world`, `medium`, each vehicle with its devices, `objects` and so on; see WorldState::part_hashes().
  void visit_state(StateArchive& archive);

  // In the order of dependence: devices are destroyed before what they refer to.
  const WorldConfig& config;
  PortOpener open_port;
  StepClock clock;
  bool in_step = false;  ///< also after a step that threw
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
  DeviceHost host;
  Entities entities;
  DeviceTable devices;
  StepSchedule schedule;
  std::unique_ptr<Script> script;  ///< null: the world was lost when a snapshot was restored
  std::optional<EndOfRun> ended;
};

}  // namespace sim
