// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "sim/scene/scene.hpp"

struct dxGeom;  // of ODE

namespace sim {

struct Mesh;

/// Counts of motions, by which the scene detects that parts must be updated.
struct SceneMoves {
  std::uint64_t moving = 0;           ///< of moving bodies: each step
  std::uint64_t jumps = 0;            ///< of moving bodies: when their pose is set
  std::uint64_t fixed = 0;            ///< of fixed bodies: when their pose is set
  std::function<void()> bring_parts;  ///< must be called before geoms of moving bodies are looked at
};

/// Part for ray casting.  Its geom has its pose and its sizes.
struct ScenePart {
  dxGeom* geom = nullptr;
  int group = -1;
  std::uint32_t category = 0;
  int material = 0;
  std::uint8_t transmits = 0;               ///< bits of RayKind that pass
  bool moving = false;                      ///< its body is not fixed
  const Mesh* mesh = nullptr;               ///< of a mesh or terrain, in the frame of the geom; must outlive the part
  std::span<const int> triangle_materials;  ///< of each triangle of `mesh`; empty: `material` for all
};

/// Scene of a PhysicsWorld, in which groups and parts are added and removed.
class WorldScene : public Scene {
 public:
  // The caller assigns the numbers of groups and parts, and may reuse those of removed ones.
  virtual void add_group(int group) = 0;
  virtual void add_part(int number, const ScenePart& part) = 0;
  /// Makes the parts of the group visible to rays.
  virtual void close_group(int group) = 0;
  /// Removes all parts of a group.  Called before their geoms are destroyed.
  virtual void remove_group(int group, std::span<const int> parts) = 0;
};

/// Makes an empty scene for the given library.  `moves` must outlive it.
std::unique_ptr<WorldScene> make_world_scene(RayLibrary library, const SceneMoves& moves);

}  // namespace sim
