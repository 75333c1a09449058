// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"

namespace sim {

/// Base of StandaloneWorld: exists before the world, and after it.
struct StandaloneBus {
  InProcessBus own_bus;  ///< of the world and all vehicles
};

/// World with its own bus inside the process, for code that steps it without programs, pages and records.
class StandaloneWorld : public StandaloneBus, public World {
 public:
  /// `config` must outlive the world.  Throws ConfigError as World does.
  explicit StandaloneWorld(const WorldConfig& config) : World(config, own_bus) {}
  explicit StandaloneWorld(const WorldConfig&&) = delete;
};

}  // namespace sim
