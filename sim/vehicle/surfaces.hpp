// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

#include "sim/model/physics_config.hpp"

namespace sim {

class PhysicsWorld;
struct VehicleConfig;
struct VehicleInstance;
struct WorldConfig;

/// Materials and contacts of a world: those of its file, and of all vehicles that were added.
class Surfaces {
 public:
  explicit Surfaces(PhysicsWorld& physics) : physics_(physics) {}

  /// Resets to the surfaces of the world file.
  void start(const WorldConfig& config);
  /// Returns whether a vehicle has new materials, contacts or categories.
  bool has_new(const VehicleConfig& config) const;
  /// Throws ConfigError where a contact of a vehicle would change the surfaces of others, or there are too many.
  void check_new(const VehicleInstance& instance) const;
  /// Adds the surfaces of a vehicle.
  void add(const VehicleConfig& config);

 private:
  PhysicsWorld& physics_;
  std::set<std::string, std::less<>> materials_;
  std::vector<ContactConfig> contacts_;
};

}  // namespace sim
