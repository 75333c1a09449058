// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "sim/geometry/mesh.hpp"
#include "sim/model/physics_config.hpp"
#include "sim/ode/ode_library.hpp"

namespace sim {

/// Creates ODE's data of a mesh.  ODE keeps pointers into `mesh`.
TriMeshDataHandle make_trimesh_data(const Mesh& mesh);

/// Triangle mesh for ODE's collisions.  ODE keeps pointers into `mesh`.
struct CollisionMesh {
  explicit CollisionMesh(Mesh loaded);
  CollisionMesh(const CollisionMesh&) = delete;
  CollisionMesh& operator=(const CollisionMesh&) = delete;

  Mesh mesh;
  bool closed = false;
  MeshSolid solid;
  TriMeshDataHandle data;
  std::vector<Vector3d> extremes_m;  ///< outermost vertices in 64 directions, without duplicates
};

/// Cache that loads each mesh file once for all parts that use it.
class MeshCache {
 public:
  /// Returns the mesh of a part.  Throws ConfigError at the part.
  const CollisionMesh& get(const PartConfig& part, const std::string& who);
  /// Finds a mesh by its ODE data; null when it is not in the cache.
  const CollisionMesh* find(dTriMeshDataID data) const;

 private:
  std::map<std::pair<std::string, double>, std::unique_ptr<CollisionMesh>> meshes_;
};

/// Creates the geom of a part of any shape except terrain, at the origin and in no space.  `mesh` is null unless the
/// shape is a mesh.
GeomHandle make_geom(const PartConfig& part, const CollisionMesh* mesh);

/// Mass, center of mass and inertia of the part in the body frame (inertia about its origin); mass 0 when the part has
/// neither mass nor density.  Throws ConfigError at the part for a mesh that is not closed.
dMass part_mass(const PartConfig& part, const CollisionMesh* mesh, const std::string& who);

}  // namespace sim
