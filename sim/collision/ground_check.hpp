// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <string>
#include <vector>

#include "sim/collision/terrain_geom.hpp"

namespace sim {

/// Part that can be in contact with a terrain.
struct GroundContact {
  dGeomID geom = nullptr;
  bool wheel = false;  ///< round, on a joint about which it can roll
  bool hard = false;   ///< its contacts with this ground have no soft_cfm
};

/// Whether all parts of a wheel have this shape: a sphere or a cylinder.
bool is_round(dGeomID geom);

/// Warnings about a pair of terrain and part with poor contact or a high cost; docs/models/terrain.md has the
/// measurements behind the rules.
std::vector<std::string> warnings_about(const CollisionTerrain& ground, const GroundContact& contact);

}  // namespace sim
