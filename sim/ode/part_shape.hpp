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

/// Makes ODE's form of a mesh.  ODE keeps pointers into `mesh`.
TriMeshDataHandle make_trimesh_data(const Mesh& mesh);

/// A triangle mesh that ODE can collide.  ODE keeps pointers into `mesh`.
struct CollisionMesh {
  explicit CollisionMesh(Mesh loaded);
  CollisionMesh(const CollisionMesh&) = delete;
  CollisionMesh& operator=(const CollisionMesh&) = delete;

  Mesh mesh;
  bool closed = false;
  MeshSolid solid;
  TriMeshDataHandle data;
  std::vector<Vector3d> extremes_m;  ///< the outermost vertices in 64 directions, each once
};

/// Each mesh file is loaded once, however many parts use it.
class MeshCache {
 public:
  /// Throws ConfigError at the part.
  const CollisionMesh& get(const PartConfig& part, const std::string& who);
  /// By ODE's data; null when it is none of these.
  const CollisionMesh* find(dTriMeshDataID data) const;

 private:
  std::map<std::pair<std::string, double>, std::unique_ptr<CollisionMesh>> meshes_;
};

/// The part's geom, at the origin and in no space, of any shape but terrain.  `mesh` is null unless it is a mesh.
GeomHandle make_geom(const PartConfig& part, const CollisionMesh* mesh);

/// Mass, centre of mass and inertia of the part, in the frame of the body (about its origin); mass 0 when the
/// part has neither mass nor density.  Throws ConfigError at the part for a mesh that encloses no solid.
dMass part_mass(const PartConfig& part, const CollisionMesh* mesh, const std::string& who);

}  // namespace sim
