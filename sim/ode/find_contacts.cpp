// SPDX-License-Identifier: BSD-3-Clause
#include "sim/ode/find_contacts.hpp"

#include <mutex>

namespace sim {

namespace {

/// Whether ODE puts the contacts of a sphere with such a geom on or near the surface of that.
bool attracts_contacts(dGeomID geom) {
  switch (dGeomGetClass(geom)) {
    case dBoxClass:
    case dCapsuleClass:
    case dCylinderClass:
    case dTriMeshClass:
      return true;
    default:
      return false;
  }
}

/// Puts contacts on a sphere, where they are with planes and terrains.  Deep ones are of bodies that were put into each
/// other, and stay.
void put_on_sphere(dGeomID sphere, dContactGeom& contact) {
  constexpr dReal deep = 0.2;
  const dReal radius = dGeomSphereGetRadius(sphere);
  if (contact.depth > deep * radius) return;
  const dReal* const center = dGeomGetPosition(sphere);
  // The normal points into the first geom.
  const dReal reach = contact.g1 == sphere ? -radius : radius;
  for (int i = 0; i < 3; ++i) contact.pos[i] = center[i] + reach * contact.normal[i];
}

}  // namespace

int find_contacts(dGeomID first, dGeomID second, int max_contacts, dContactGeom* contacts, int skip_bytes) {
  static std::mutex meshes;
  std::unique_lock<std::mutex> lock(meshes, std::defer_lock);
  // ODE keeps temporal data of triangle meshes in the geoms, so collisions with them are not thread-safe.
  if (dGeomGetClass(first) == dTriMeshClass || dGeomGetClass(second) == dTriMeshClass) lock.lock();
  const int count = dCollide(first, second, max_contacts, contacts, skip_bytes);
  const bool is_first = dGeomGetClass(first) == dSphereClass;
  const dGeomID sphere = is_first ? first : second;
  if (dGeomGetClass(sphere) == dSphereClass && attracts_contacts(is_first ? second : first))
    for (int i = 0; i < count; ++i)
      put_on_sphere(sphere, *reinterpret_cast<dContactGeom*>(reinterpret_cast<char*>(contacts) + i * skip_bytes));
  return count;
}

}  // namespace sim
