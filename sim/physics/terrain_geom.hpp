// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <string>
#include <vector>

#include "sim/model/physics_config.hpp"
#include "sim/ode/ode_library.hpp"
#include "sim/ode/part_shape.hpp"
#include "sim/physics/contact_table.hpp"
#include "sim/terrain/terrain.hpp"

namespace sim {

/// Ground that ODE can collide and rays can see.  Its geom keeps pointers into it.
struct CollisionTerrain {
  /// Reads or makes the terrain of a part.  `table` has its materials; `meshes` are those of the world.  Throws
  /// ConfigError at the part's `terrain`.
  CollisionTerrain(const PartConfig& part, const std::string& who, const ContactTable& table, const MeshCache& meshes);
  CollisionTerrain(const CollisionTerrain&) = delete;
  CollisionTerrain& operator=(const CollisionTerrain&) = delete;

  /// Of the cell below a place.  `geom` says where the terrain lies.
  int material_at(dGeomID geom, const Vector3d& p_W) const;

  Terrain terrain;
  Mesh mesh;
  std::vector<int> area_materials;      ///< by number of the area; 0 is the part's own
  std::vector<int> triangle_materials;  ///< of each triangle; empty: all are the part's own
  const TerrainCollision collision;
  const MeshCache& meshes;

  // ODE's forms, when `collision` needs them.
  TriMeshDataHandle trimesh;
  HeightfieldDataHandle heightfield;
  GeomHandle heightfield_geom;  ///< in no space: the terrain's geom asks it
};

/// A geom in the frame of the terrain, at the origin and in no space: for `mesh` a trimesh; else of our own class,
/// whose collider meets spheres, boxes, capsules, cylinders and meshes, in bounded time whatever the size of the cells.
/// All that lies below the surface counts as inside, down to 100 m below its lowest point.
GeomHandle make_terrain_geom(const CollisionTerrain& terrain);

/// ODE's collider of smooth ground: `o1` is the terrain's geom.  As a dColliderFn.
int collide_with_smooth(const CollisionTerrain& terrain, dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts,
                        int skip);

}  // namespace sim
