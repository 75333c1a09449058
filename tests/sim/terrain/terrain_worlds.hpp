// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

#include "tests/sim/physics/small_worlds.hpp"

/// Ground of a rule, for tests.
namespace terrain_worlds {

using namespace small_worlds;
using sim::TerrainCollision;
using TerrainSource = sim::TerrainConfig::Source;

inline PartConfig terrain(TerrainSource source, double cell_m, TerrainCollision collision = TerrainCollision::smooth) {
  PartConfig part;
  part.shape = PartShape::terrain;
  part.terrain.emplace();
  part.terrain->source = source;
  part.terrain->cell_m = cell_m;
  part.terrain->collision = collision;
  return part;
}

/// Level, 20 m x 20 m.
inline PartConfig level_ground(double cell_m, TerrainCollision collision = TerrainCollision::smooth) {
  PartConfig part = terrain(TerrainSource::slope, cell_m, collision);
  part.terrain->size_m = {20, 20};
  return part;
}

/// Waves along x.
inline PartConfig waves(double cell_m, TerrainCollision collision, double amplitude_m, double wavelength_m) {
  PartConfig part = terrain(TerrainSource::sine, cell_m, collision);
  part.terrain->size_m = {80, 4};
  part.terrain->amplitude_m = amplitude_m;
  part.terrain->wavelength_m = wavelength_m;
  return part;
}

inline sim::Body& add_terrain(PhysicsWorld& world, const PartConfig& part, const Pose& X_W = Pose::Identity()) {
  return add(world, body("hill", {part}), X_W, Motion::fixed);
}

/// A wheel of radius 0.1 m and width 0.06 m, its axis along y.
inline PartConfig cylinder_wheel() {
  return at(round(PartShape::cylinder, 0.1, 0.06, 0.5), Vector3d::Zero(), {std::numbers::pi / 2, 0, 0});
}

}  // namespace terrain_worlds
