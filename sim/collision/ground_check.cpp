// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/ground_check.hpp"

#include <algorithm>

#include "sim/config/message_text.hpp"
#include "sim/ode/ode_math.hpp"

namespace sim {

namespace {

/// Side lengths of a box; of a sphere or a cylinder the radius first.
Vector3d size_of(dGeomID geom) {
  dReal a = 0, b = 0;
  dVector3 lengths = {0, 0, 0, 0};
  switch (dGeomGetClass(geom)) {
    case dSphereClass:
      return {dGeomSphereGetRadius(geom), 0, 0};
    case dCylinderClass:
      dGeomCylinderGetParams(geom, &a, &b);
      return {a, b, 0};
    case dBoxClass:
      dGeomBoxGetLengths(geom, lengths);
      return to_eigen(lengths);
    default:
      return Vector3d::Zero();
  }
}

}  // namespace

bool is_round(dGeomID geom) {
  const int geom_class = dGeomGetClass(geom);
  return geom_class == dSphereClass || geom_class == dCylinderClass;
}

std::vector<std::string> warnings_about(const CollisionTerrain& ground, const GroundContact& contact) {
  const double cell_m = ground.terrain.grid.cell_m;
  const Vector3d size_m = size_of(contact.geom);
  const int geom_class = dGeomGetClass(contact.geom);
  std::vector<std::string> found;
  switch (ground.collision) {
    case TerrainCollision::smooth:
      // One contact point per wheel: small bumps are missed.
      if (contact.wheel && cell_m < size_m.x() / 4)
        found.push_back("cells of " + number_text(cell_m) + " m are much smaller than a wheel of radius " +
                        number_text(size_m.x()) + " m, which touches the ground at one point: bumps may be missed");
      break;
    case TerrainCollision::facets: {
      // Many facets below a part are slow; hard contacts at their edges oscillate.
      if (contact.wheel && cell_m < 2 * size_m.x())
        found.push_back("facets of " + number_text(cell_m) + " m are smaller than a wheel of " +
                        number_text(2 * size_m.x()) + " m, which costs their square: use collision: smooth");
      if (contact.wheel && contact.hard)
        found.push_back(
            "hard contacts of a wheel jump from facet to facet, and accelerations ring: use collision: smooth, or give "
            "the contact a soft_cfm");
      constexpr double max_cells = 64;  // about 20 us a contact
      const Vector3d cells = size_m / cell_m;
      if (geom_class == dBoxClass &&
          cells.x() * cells.y() * cells.z() / std::min({cells.x(), cells.y(), cells.z()}) > max_cells)
        found.push_back("a box of " + number_text(size_m.maxCoeff()) + " m covers many facets of " +
                        number_text(cell_m) + " m, which costs their square: use collision: smooth");
      break;
    }
    case TerrainCollision::mesh:
      if (contact.wheel && geom_class == dCylinderClass)
        found.push_back(
            "a cylinder wheel on triangles has a dozen contacts, and jitters: use collision: smooth, or a "
            "sphere as wheel");
  }
  return found;
}

}  // namespace sim
