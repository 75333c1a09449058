// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/terrain_geom.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "sim/ode/ode_math.hpp"

namespace sim {
namespace {

constexpr double thickness_m = 100;

/// Height for ODE, whose rows run from north to south; rows of HeightGrid run from south to north.
dReal height_for_ode(void* user, int column, int row) {
  const HeightGrid& grid = static_cast<const CollisionTerrain*>(user)->terrain.grid;
  return grid.at(column, grid.rows - 1 - row);
}

void make_heightfield(CollisionTerrain& terrain) {
  const HeightGrid& grid = terrain.terrain.grid;
  terrain.heightfield.reset(dGeomHeightfieldDataCreate());
  dGeomHeightfieldDataBuildCallback(terrain.heightfield.get(), &terrain, &height_for_ode, grid.width_m(),
                                    grid.depth_m(), grid.columns, grid.rows, 1, 0, thickness_m, 0);
  dGeomHeightfieldDataSetBounds(terrain.heightfield.get(), grid.lowest_m(), grid.highest_m());
  terrain.heightfield_geom.reset(dCreateHeightfield(nullptr, terrain.heightfield.get(), 1));
}

struct ClassData {
  const CollisionTerrain* terrain;
};

const CollisionTerrain& terrain_of(dGeomID geom) {
  return *static_cast<ClassData*>(dGeomGetClassData(geom))->terrain;
}

/// Poses ODE's heightfield, which has y up and its origin in its center.
void place_heightfield(const CollisionTerrain& terrain, dGeomID at) {
  const HeightGrid& grid = terrain.terrain.grid;
  const Matrix3d R_WT = rotation_to_eigen(dGeomGetRotation(at));
  const Vector3d middle_T(grid.west_m + grid.width_m() / 2, grid.south_m + grid.depth_m() / 2, 0);
  const Vector3d p_W = to_eigen(dGeomGetPosition(at)) + R_WT * middle_T;
  Matrix3d R_WH;
  R_WH << R_WT.col(0), R_WT.col(2), -R_WT.col(1);
  dMatrix3 R;
  to_ode(R_WH, R);
  dGeomSetPosition(terrain.heightfield_geom.get(), p_W.x(), p_W.y(), p_W.z());
  dGeomSetRotation(terrain.heightfield_geom.get(), R);
}

int collide_with_terrain(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) {
  const CollisionTerrain& terrain = terrain_of(o1);
  if (terrain.collision == TerrainCollision::smooth) return collide_with_smooth(terrain, o1, o2, flags, contacts, skip);
  // ODE keeps the cells that it tests in the heightfield.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  place_heightfield(terrain, o1);
  const int count = dCollide(terrain.heightfield_geom.get(), o2, flags, contacts, skip);
  for (int i = 0; i < count; ++i)
    reinterpret_cast<dContactGeom*>(reinterpret_cast<char*>(contacts) + i * static_cast<std::ptrdiff_t>(skip))->g1 = o1;
  return count;
}

dColliderFn* collider_for(int geom_class) {
  switch (geom_class) {
    case dSphereClass:
    case dBoxClass:
    case dCapsuleClass:
    case dCylinderClass:
    case dTriMeshClass:
      return &collide_with_terrain;
    default:
      return nullptr;
  }
}

void box_around(dGeomID geom, dReal box[6]) {
  const HeightGrid& grid = terrain_of(geom).terrain.grid;
  const Matrix3d R_WT = rotation_to_eigen(dGeomGetRotation(geom));
  const Vector3d low(grid.west_m, grid.south_m, grid.lowest_m() - thickness_m);
  const Vector3d high(grid.west_m + grid.width_m(), grid.south_m + grid.depth_m(), grid.highest_m());
  const Vector3d middle_W = to_eigen(dGeomGetPosition(geom)) + R_WT * (low + high) / 2;
  const Vector3d half_W = R_WT.cwiseAbs() * (high - low) / 2;
  for (int i = 0; i < 3; ++i) {
    box[2 * i] = middle_W[i] - half_W[i];
    box[2 * i + 1] = middle_W[i] + half_W[i];
  }
}

/// Geom class of terrain, registered once per process; ODE has room for four classes.
int terrain_class() {
  static const int number = [] {
    dGeomClass terrain{};
    terrain.bytes = sizeof(ClassData);
    terrain.collider = &collider_for;
    terrain.aabb = &box_around;
    return dCreateGeomClass(&terrain);
  }();
  return number;
}

Terrain load(const PartConfig& part, const std::string& who) {
  try {
    return load_terrain(*part.terrain);
  } catch (const TerrainError& error) {
    throw_config_error(part.terrain->place, who, std::string("terrain ") + error.what());
  }
}

}  // namespace

CollisionTerrain::CollisionTerrain(const PartConfig& part, const std::string& who, const ContactTable& table,
                                   const MeshCache& meshes_)
    : terrain(load(part, who)), mesh(mesh_of(terrain.grid)), collision(part.terrain->collision), meshes(meshes_) {
  area_materials.push_back(table.number_of(part.material));
  for (const TerrainAreaConfig& area : part.terrain->areas) area_materials.push_back(table.number_of(area.material));
  triangle_materials.reserve(2 * terrain.area_of_cell.size());
  for (const std::uint8_t area : terrain.area_of_cell)
    triangle_materials.insert(triangle_materials.end(), 2, area_materials[area]);
  switch (collision) {
    case TerrainCollision::smooth:
      break;
    case TerrainCollision::facets:
      make_heightfield(*this);
      break;
    case TerrainCollision::mesh:
      trimesh = make_trimesh_data(mesh);
      break;
  }
}

int CollisionTerrain::material_at(dGeomID geom, const Vector3d& p_W) const {
  if (terrain.area_of_cell.empty()) return area_materials[0];
  const Vector3d p_T = rotation_to_eigen(dGeomGetRotation(geom)).transpose() * (p_W - to_eigen(dGeomGetPosition(geom)));
  return area_materials[static_cast<std::size_t>(terrain.area_at(p_T.x(), p_T.y()))];
}

GeomHandle make_terrain_geom(const CollisionTerrain& terrain) {
  if (terrain.trimesh) return GeomHandle(dCreateTriMesh(nullptr, terrain.trimesh.get(), nullptr, nullptr, nullptr));
  GeomHandle geom(dCreateGeom(terrain_class()));
  static_cast<ClassData*>(dGeomGetClassData(geom.get()))->terrain = &terrain;
  return geom;
}

}  // namespace sim
