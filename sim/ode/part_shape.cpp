// SPDX-License-Identifier: BSD-3-Clause
#include "sim/ode/part_shape.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "sim/ode/ode_math.hpp"

namespace sim {

TriMeshDataHandle make_trimesh_data(const Mesh& mesh) {
  TriMeshDataHandle data(dGeomTriMeshDataCreate());
  static_assert(sizeof(dTriIndex) == sizeof(mesh.triangles[0][0]) && sizeof(Vector3d) == 3 * sizeof(double));
  dGeomTriMeshDataBuildDouble(data.get(), mesh.vertices_m.data(), sizeof(Vector3d),
                              static_cast<int>(mesh.vertices_m.size()), mesh.triangles.data(),
                              static_cast<int>(3 * mesh.triangles.size()), sizeof(mesh.triangles[0]));
  return data;
}

namespace {

/// Outermost vertices of a mesh in directions spread evenly over the sphere (Fibonacci lattice): its possible contact
/// points in any attitude.
std::vector<Vector3d> extremes_of(const Mesh& mesh) {
  constexpr int directions = 64;
  std::vector<std::uint32_t> found;
  for (int i = 0; i < directions; ++i) {
    const double z = 1 - (2 * i + 1.0) / directions, level = std::sqrt(1 - z * z);
    const double turn = 2 * std::numbers::pi * i * (std::numbers::phi - 1);
    const Vector3d direction(level * std::cos(turn), level * std::sin(turn), z);
    std::uint32_t best = mesh.triangles.front()[0];
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t corner : triangle)
        if (direction.dot(mesh.vertices_m[corner]) > direction.dot(mesh.vertices_m[best])) best = corner;
    found.push_back(best);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::vector<Vector3d> extremes;
  for (const std::uint32_t vertex : found) extremes.push_back(mesh.vertices_m[vertex]);
  return extremes;
}

}  // namespace

CollisionMesh::CollisionMesh(Mesh loaded) : mesh(std::move(loaded)), closed(is_closed(mesh)) {
  if (closed) solid = solid_of(mesh);
  if (solid.volume_m3 < 0) {
    // Triangles that face inwards would attract other bodies instead of pushing them out.
    turn_inside_out(mesh);
    solid = solid_of(mesh);
  }
  data = make_trimesh_data(mesh);
  extremes_m = extremes_of(mesh);
}

const CollisionMesh& MeshCache::get(const PartConfig& part, const std::string& who) {
  const std::string path = (std::filesystem::path(part.directory) / part.mesh).string();
  std::unique_ptr<CollisionMesh>& cached = meshes_[{path, part.scale}];
  try {
    if (!cached) cached = std::make_unique<CollisionMesh>(load_mesh(path, part.scale));
  } catch (const MeshError& error) {
    throw_config_error(part.place, who, "mesh '" + path + "' " + error.what());
  }
  return *cached;
}

const CollisionMesh* MeshCache::find(dTriMeshDataID data) const {
  for (const auto& [name, mesh] : meshes_)
    if (mesh && mesh->data.get() == data) return mesh.get();
  return nullptr;
}

GeomHandle make_geom(const PartConfig& part, const CollisionMesh* mesh) {
  switch (part.shape) {
    case PartShape::box:
      return GeomHandle(dCreateBox(nullptr, part.size_m.x(), part.size_m.y(), part.size_m.z()));
    case PartShape::sphere:
      return GeomHandle(dCreateSphere(nullptr, part.radius_m));
    case PartShape::capsule:
      return GeomHandle(dCreateCapsule(nullptr, part.radius_m, part.length_m));
    case PartShape::cylinder:
      return GeomHandle(dCreateCylinder(nullptr, part.radius_m, part.length_m));
    case PartShape::plane:
      return GeomHandle(dCreatePlane(nullptr, 0, 0, 1, 0));
    case PartShape::mesh:
    case PartShape::terrain:  // made by make_terrain_geom
      break;
  }
  assert(part.shape == PartShape::mesh && mesh != nullptr);
  return GeomHandle(dCreateTriMesh(nullptr, mesh->data.get(), nullptr, nullptr, nullptr));
}

namespace {

/// Mass of the shape in its own frame, with density 1.
dMass unit_density_mass(const PartConfig& part, const CollisionMesh* mesh) {
  dMass mass;
  dMassSetZero(&mass);
  constexpr int along_z = 3;
  switch (part.shape) {
    case PartShape::box:
      dMassSetBox(&mass, 1, part.size_m.x(), part.size_m.y(), part.size_m.z());
      break;
    case PartShape::sphere:
      dMassSetSphere(&mass, 1, part.radius_m);
      break;
    case PartShape::capsule:
      dMassSetCapsule(&mass, 1, along_z, part.radius_m, part.length_m);
      break;
    case PartShape::cylinder:
      dMassSetCylinder(&mass, 1, along_z, part.radius_m, part.length_m);
      break;
    case PartShape::mesh: {
      if (mesh == nullptr) break;
      // Volume, inertia and centroid of the solid.
      const MeshSolid& solid = mesh->solid;
      dMassSetParameters(&mass, solid.volume_m3, 0, 0, 0, solid.inertia(0, 0), solid.inertia(1, 1), solid.inertia(2, 2),
                         solid.inertia(0, 1), solid.inertia(0, 2), solid.inertia(1, 2));
      dMassTranslate(&mass, solid.centroid_m.x(), solid.centroid_m.y(), solid.centroid_m.z());
      break;
    }
    case PartShape::plane:
    case PartShape::terrain:
      break;
  }
  return mass;
}

}  // namespace

dMass part_mass(const PartConfig& part, const CollisionMesh* mesh, const std::string& who) {
  dMass mass;
  dMassSetZero(&mass);
  if (!part.mass_kg && !part.density_kgpm3) return mass;
  if (mesh != nullptr && !mesh->closed)
    throw_config_error(part.place, who,
                       "mesh '" + part.mesh + "' has an open surface, so that its inertia is unknown: close it, or " +
                           "put the mass into another part");
  mass = unit_density_mass(part, mesh);
  if (!(mass.mass > 0)) throw_config_error(part.place, who, "encloses no volume");
  dMassAdjust(&mass, part.mass_kg ? *part.mass_kg : *part.density_kgpm3 * mass.mass);
  // The inertia of the shape is about its own axes at its center; it moves to the frame of the body.
  dMatrix3 R;
  to_ode(rotation_from_rpy(part.rpy_rad), R);
  dMassRotate(&mass, R);
  dMassTranslate(&mass, part.position_m.x(), part.position_m.y(), part.position_m.z());
  return mass;
}

}  // namespace sim
