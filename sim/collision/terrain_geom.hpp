// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <string>
#include <vector>

#include "sim/collision/contact_table.hpp"
#include "sim/model/physics_config.hpp"
#include "sim/ode/ode_library.hpp"
#include "sim/ode/part_shape.hpp"
#include "sim/terrain/terrain.hpp"

namespace sim {

/// Terrain for ODE's collisions and for rays.  Its geom keeps pointers into it.
struct CollisionTerrain {
  /// Reads or generates the terrain of a part.  `table` has its materials; `meshes` are those of the world.  Throws
  /// ConfigError at the part's `terrain`.
  CollisionTerrain(const PartConfig& part, const std::string& who, const ContactTable& table, const MeshCache& meshes);
  CollisionTerrain(const CollisionTerrain&) = delete;
  CollisionTerrain& operator=(const CollisionTerrain&) = delete;

  /// Material of the cell below a point.  `geom` has the pose of the terrain.
  int material_at(dGeomID geom, const Vector3d& p_W) const;

  Terrain terrain;
  Mesh mesh;
  std::vector<int> area_materials;      ///< by number of the area; 0 is the material of the part
  std::vector<int> triangle_materials;  ///< of each triangle; empty: the material of the part
  const TerrainCollision collision;
  const MeshCache& meshes;

  // ODE's data, for the kinds of `collision` that use them.
  TriMeshDataHandle trimesh;
  HeightfieldDataHandle heightfield;
  GeomHandle heightfield_geom;  ///< in no space: the terrain's geom calls it
};

/// Creates a geom in the frame of the terrain, at the origin and in no space: for `mesh` a trimesh; else of the
/// simulator's own geom class, which collides with spheres, boxes, capsules, cylinders and meshes in bounded time
/// whatever the cell size.  Points below the surface are inside, down to 100 m below its lowest point.
GeomHandle make_terrain_geom(const CollisionTerrain& terrain);

/// Collider of smooth terrain, as a dColliderFn: `o1` is the terrain's geom.
int collide_with_smooth(const CollisionTerrain& terrain, dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts,
                        int skip);

}  // namespace sim
