// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "sim/scene/ray_library.hpp"
#include "sim/scene/scene.hpp"

struct dxGeom;  // ODE's

namespace sim {

struct Mesh;

/// Counts of movements, by which the scene detects that parts must be updated.
struct SceneMoves {
  std::uint64_t moving = 0;  ///< bodies that move: each step
  std::uint64_t fixed = 0;   ///< fixed bodies: only when someone puts them elsewhere
};

/// A part as rays see it.  Its pose and its sizes are the geom's.
struct ScenePart {
  dxGeom* geom = nullptr;
  int group = -1;
  std::uint32_t category = 0;
  int material = 0;
  std::uint8_t transmits = 0;  ///< bits of RayKind that pass
  bool moving = false;         ///< its body is not fixed
  const Mesh* mesh = nullptr;  ///< of a mesh or terrain, in the frame of the geom; lives as long as the part
  std::span<const int> triangle_materials;  ///< of each triangle of `mesh`; empty: all are of `material`
};

/// A scene that follows a PhysicsWorld, in which groups and parts are added and removed.
class WorldScene : public Scene {
 public:
  // Numbers of groups and parts are assigned by the caller, who may reuse those of removed entities.
  virtual void add_group(int group) = 0;
  virtual void add_part(int number, const ScenePart& part) = 0;
  /// From now on rays see the parts of the group.
  virtual void close_group(int group) = 0;
  /// Rays see these parts, all that the group has, no more.  Called before their geoms are destroyed.
  virtual void remove_group(int group, std::span<const int> parts) = 0;
};

std::unique_ptr<WorldScene> make_world_scene(RayLibrary library, const SceneMoves& moves);

}  // namespace sim
