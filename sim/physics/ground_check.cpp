// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "sim/config/message_text.hpp"
#include "sim/ode/ode_math.hpp"
#include "sim/physics/physics_world_impl.hpp"

// Warnings about pairs of terrain and parts with poor contact or a high cost; docs/models/terrain.md has the
// measurements behind the rules.  And bodies that move further than their size in a step: contacts are only found where
// parts overlap at its end.

namespace sim {
namespace {

/// Part that can be in contact with the ground.
struct Stander {
  std::string name;
  int geom_class = 0;
  Vector3d size_m = Vector3d::Zero();  ///< box: side lengths; sphere, cylinder: radius first
  bool wheel = false;
  bool hard = false;  ///< its contacts with this ground have no soft_cfm
};

/// Warnings about part `it` on a terrain.
std::vector<std::string> warnings_about(const CollisionTerrain& ground, const Stander& it) {
  const double cell_m = ground.terrain.grid.cell_m;
  std::vector<std::string> found;
  switch (ground.collision) {
    case TerrainCollision::smooth:
      // One contact point per wheel: small bumps are missed.
      if (it.wheel && cell_m < it.size_m.x() / 4)
        found.push_back("cells of " + number_text(cell_m) + " m are much smaller than a wheel of radius " +
                        number_text(it.size_m.x()) + " m, which touches the ground at one point: bumps may be missed");
      break;
    case TerrainCollision::facets: {
      // Many facets below a part are slow; hard contacts at their edges oscillate.
      if (it.wheel && cell_m < 2 * it.size_m.x())
        found.push_back("facets of " + number_text(cell_m) + " m are smaller than a wheel of " +
                        number_text(2 * it.size_m.x()) + " m, which costs their square: use collision: smooth");
      if (it.wheel && it.hard)
        found.push_back(
            "hard contacts of a wheel jump from facet to facet, and accelerations ring: use collision: smooth, or give "
            "the contact a soft_cfm");
      constexpr double max_cells = 64;  // about 20 us a contact
      const Vector3d cells = it.size_m / cell_m;
      if (it.geom_class == dBoxClass &&
          cells.x() * cells.y() * cells.z() / std::min({cells.x(), cells.y(), cells.z()}) > max_cells)
        found.push_back("a box of " + number_text(it.size_m.maxCoeff()) + " m covers many facets of " +
                        number_text(cell_m) + " m, which costs their square: use collision: smooth");
      break;
    }
    case TerrainCollision::mesh:
      if (it.wheel && it.geom_class == dCylinderClass)
        found.push_back(
            "a cylinder wheel on triangles has a dozen contacts, and jitters: use collision: smooth, or a "
            "sphere as wheel");
  }
  return found;
}

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

/// Returns the box of all parts of a body, in the axes of the world; an empty one without parts.
Eigen::AlignedBox3d box_around(dBodyID ode) {
  Eigen::AlignedBox3d box;
  for (dGeomID geom = dBodyGetFirstGeom(ode); geom != nullptr; geom = dBodyGetNextGeom(geom)) {
    dReal sides[6];
    dGeomGetAABB(geom, sides);
    box.extend(Eigen::AlignedBox3d(Vector3d(sides[0], sides[2], sides[4]), Vector3d(sides[1], sides[3], sides[5])));
  }
  return box;
}

}  // namespace

std::vector<std::string> PhysicsWorld::ground_warnings() const {
  const Impl& all = *impl_;
  if (all.terrains.empty()) return {};
  // Find the bodies on joints that can carry a wheel.
  std::set<dBodyID> hinged;  // never iterated, as the order of pointers varies
  for (const auto& joint : all.joints)
    if (joint && joint_info(joint->type()).carries_a_wheel)
      for (const int end : {0, 1}) hinged.insert(dJointGetBody(joint->ode_.get(), end));

  std::set<int> angular;  // bodies with parts other than spheres and cylinders: not wheels
  for (std::size_t i = 0; i < all.parts.size(); ++i) {
    if (all.parts[i].group < 0) continue;
    const int geom_class = dGeomGetClass(all.collider.parts()[i].geom);
    if (geom_class != dSphereClass && geom_class != dCylinderClass) angular.insert(all.parts[i].body);
  }

  // Check each free part on each terrain.
  std::vector<std::string> warnings;
  for (const auto& [number, ground] : all.terrains) {
    std::map<std::string, std::pair<std::string, int>> named;  // by warning: name of the first part, number of parts
    const CollisionPart& under = all.collider.parts()[static_cast<std::size_t>(number)];
    for (std::size_t i = 0; i < all.parts.size(); ++i) {
      const CollisionPart& part = all.collider.parts()[i];
      if (all.parts[i].group < 0 || !all.bodies[static_cast<std::size_t>(part.body)]->free()) continue;
      if ((part.category & under.collides_with) == 0 || (under.category & part.collides_with) == 0) continue;
      Stander it{all.parts[i].name, dGeomGetClass(part.geom), size_of(part.geom), false, false};
      it.wheel = hinged.contains(dGeomGetBody(part.geom)) && !angular.contains(part.body);
      for (const int material : ground->area_materials)
        it.hard |= (all.collider.table().of(part.material, material).parameters.mode & dContactSoftCFM) == 0;
      for (std::string& warning : warnings_about(*ground, it)) {
        auto& [first, count] = named[std::move(warning)];
        if (count++ == 0) first = it.name;
      }
    }
    // Report equal warnings once.
    for (const auto& [warning, parts] : named)
      warnings.push_back("terrain '" + all.parts[static_cast<std::size_t>(number)].name + "' under '" + parts.first +
                         "'" + (parts.second > 1 ? " and " + std::to_string(parts.second - 1) + " more" : "") + ": " +
                         warning);
  }
  return warnings;
}

/// Sets the speeds of a new group from which on its bodies are looked at.
void PhysicsWorld::Impl::plan_leaps(const Group& group) {
  for (Body* body : group.moving) {
    if (!body->free()) continue;
    const Eigen::AlignedBox3d box = box_around(body->ode_.get());
    if (box.isEmpty()) continue;
    const double speed_mps = box.sizes().minCoeff() / config.step_s;
    body->leap_m2ps2_ = speed_mps * speed_mps;
  }
}

/// Forgets which bodies have moved too far: a restored world may come to it again.
void PhysicsWorld::Impl::plan_leaps_anew() {
  may_leap.clear();
  leaps.clear();
  for (const Group& group : groups)
    if (group.in_use) plan_leaps(group);
}

void PhysicsWorld::Impl::note_may_leap(const std::vector<int>& fast) {
  if (fast.empty()) return;
  const std::lock_guard lock(left_mutex);
  may_leap.insert(may_leap.end(), fast.begin(), fast.end());
}

void PhysicsWorld::Impl::find_leaps() {
  if (may_leap.empty()) return;
  std::sort(may_leap.begin(), may_leap.end());
  for (const int number : may_leap) {
    Body& body = *bodies[static_cast<std::size_t>(number)];
    if (far_groups.far(body.group_)) continue;
    const Vector3d v_W = to_eigen(body.v_WC_W_);
    const double speed_mps = v_W.norm(), moved_m = speed_mps * config.step_s;
    mark_as_moved(body);
    const double size_m = box_around(body.ode_.get()).sizes().dot(v_W.cwiseAbs()) / speed_mps;
    constexpr double faster = 1.2;  // until it is looked at again, for it may turn
    body.leap_m2ps2_ = faster * faster * speed_mps * speed_mps;
    if (moved_m <= size_m) continue;
    body.leap_m2ps2_ = std::numeric_limits<double>::infinity();
    leaps.push_back({number, moved_m, size_m});
  }
  may_leap.clear();
}

std::vector<Leap> PhysicsWorld::take_leaps() {
  return std::exchange(impl_->leaps, {});
}

}  // namespace sim
