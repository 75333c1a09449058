// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_warnings.hpp"

#include "sim/world/world.hpp"

namespace sim {

Warnings& warnings_of(World& world) {
  return world.shared<Warnings>();
}

}  // namespace sim
