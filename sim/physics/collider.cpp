// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/collider.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/free_numbers.hpp"
#include "sim/geometry/box_grid.hpp"
#include "sim/ode/find_contacts.hpp"
#include "sim/ode/ode_math.hpp"
#include "sim/physics/terrain_geom.hpp"

namespace sim {
namespace {

dSpaceID create_space(PhysicsConfig::Space kind) {
  switch (kind) {
    case PhysicsConfig::Space::sap:
      return dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
    case PhysicsConfig::Space::quadtree: {
      // Geoms outside this square are found too, at a higher cost.
      const dVector3 center = {0, 0, 0, 0}, extents = {1024, 1024, 1024, 0};
      return dQuadTreeSpaceCreate(nullptr, center, extents, 7);
    }
    case PhysicsConfig::Space::hash:
      return dHashSpaceCreate(nullptr);
    case PhysicsConfig::Space::simple:
      break;
  }
  return dSimpleSpaceCreate(nullptr);
}

SpaceHandle make_space(PhysicsConfig::Space kind) {
  const dSpaceID space = create_space(kind);
  dSpaceSetCleanup(space, 0);  // geoms are owned by GeomHandle
  return SpaceHandle(space);
}

}  // namespace

Collider::Collider(const PhysicsConfig& config, ContactTable table)
    : table_(std::move(table)),
      step_s_(config.step_s),
      surface_layer_m_(config.contact_surface_layer_m),
      space_(make_space(config.space)),
      touching_(static_cast<std::size_t>(config.max_contacts_per_pair)) {
  set_gravity(config.gravity_mps2);
}

void Collider::set_gravity(double gravity_mps2) {
  gravity_mps2_ = gravity_mps2;
  still_mps_ = std::max(1e-6, 0.01 * step_s_ * std::abs(gravity_mps2));
}

void Collider::add_group(int number, bool self_collision) {
  Group& group = slot(groups_, number);
  group.space = make_space(PhysicsConfig::Space::simple);
  group.self_collision = self_collision;
  dSpaceSetSublevel(group.space.get(), 1);
  dGeomSetCategoryBits(reinterpret_cast<dGeomID>(group.space.get()), 0);
  dGeomSetCollideBits(reinterpret_cast<dGeomID>(group.space.get()), 0);
}

void Collider::add_body(int number, const CollisionBody& body) {
  slot(bodies_, number) = body;
  slot(joined_, number).clear();
}

void Collider::add_part(int number, const CollisionPart& part, GeomHandle geom, Motion motion) {
  slot(parts_, number) = part;
  parts_[number].geom = geom.get();
  dGeomSetData(geom.get(), reinterpret_cast<void*>(static_cast<std::intptr_t>(number)));
  dGeomSetCategoryBits(geom.get(), part.category);
  // Parts of bodies that are not free have no collide bits, so that the space drops pairs of two such parts at once.
  const unsigned long collides = motion == Motion::free ? part.collides_with : 0;
  dGeomSetCollideBits(geom.get(), collides);
  Group& group = groups_[part.group];
  if (motion != Motion::fixed) {
    const auto as_geom = reinterpret_cast<dGeomID>(group.space.get());
    dGeomSetCategoryBits(as_geom, dGeomGetCategoryBits(as_geom) | part.category);
    dGeomSetCollideBits(as_geom, dGeomGetCollideBits(as_geom) | collides);
    dSpaceAdd(group.space.get(), geom.get());
  } else {
    // Added directly to the world's space: a single bounding box around, say, a whole harbour would exclude nothing.
    group.fixed.push_back(geom.get());
  }
  slot(geoms_, number) = std::move(geom);
}

void Collider::join(int first, int second) {
  joined_[first].push_back(second);
  joined_[second].push_back(first);
}

void Collider::close_group(int number) {
  Group& group = groups_[number];
  if (dSpaceGetNumGeoms(group.space.get()) > 0 && !dGeomGetSpace(reinterpret_cast<dGeomID>(group.space.get())))
    dSpaceAdd(space_.get(), reinterpret_cast<dGeomID>(group.space.get()));
  for (const dGeomID geom : group.fixed) dSpaceAdd(space_.get(), geom);
  group.fixed.clear();
}

void Collider::remove_group(int number, std::span<const int> bodies, std::span<const int> parts) {
  for (const int part : parts) {
    geoms_[part].reset();  // leaves its space and its body
    parts_[part] = {};
  }
  for (const int body : bodies) {
    bodies_[body] = {};
    joined_[body].clear();
  }
  watchers_ -= groups_[number].watchers;
  groups_[number] = {};
}

void Collider::watch(int group) {
  ++groups_[group].watchers;
  ++watchers_;
}

void Collider::unwatch(int group) {
  if (groups_[group].watchers == 0) return;
  --groups_[group].watchers;
  --watchers_;
}

int Collider::collide(dWorldID world, dJointGroupID contacts, Islands& islands) {
  pairs_.clear();
  dSpaceCollide(space_.get(), this, &Collider::on_near);
  for (const Group& group : groups_)
    if (group.self_collision) dSpaceCollide(group.space.get(), this, &Collider::on_near);
  sort_pairs();
  watched_.clear();
  int count = 0;
  for (const std::uint64_t pair : pairs_)
    count += touch(static_cast<int>(pair >> 32), static_cast<int>(pair & 0xffffffff), world, contacts, islands);
  feedback_.resize(watched_.size());
  for (std::size_t i = 0; i < watched_.size(); ++i) dJointSetFeedback(watched_[i].joint, &feedback_[i]);
  return count;
}

void Collider::read_forces(std::vector<ContactReport>& reports) const {
  reports.clear();
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    reports.push_back(watched_[i].report);
    const Vector3d force_W_N = to_eigen(feedback_[i].f1);
    reports.back().force_W_N = watched_[i].turned ? Vector3d(-force_W_N) : force_W_N;
  }
}

namespace {

AlignedBox box_of(dGeomID geom) {
  dReal b[6];
  dGeomGetAABB(geom, b);
  return {{b[0], b[2], b[4]}, {b[1], b[3], b[5]}};
}

}  // namespace

Collider::Overlap Collider::deepest_overlap(int group) const {
  // Collect the parts of the group, and those of other groups near them.
  std::vector<std::pair<const CollisionPart*, AlignedBox>> own_parts, others;
  for (const CollisionPart& part : parts_)
    if (part.geom != nullptr && part.group == group) own_parts.emplace_back(&part, box_of(part.geom));
  if (own_parts.empty()) return {};
  AlignedBox around = own_parts.front().second;
  for (const auto& [part, box] : own_parts) around = {around.low.cwiseMin(box.low), around.high.cwiseMax(box.high)};
  for (const CollisionPart& part : parts_) {
    if (part.geom == nullptr || part.group == group) continue;
    const AlignedBox box = box_of(part.geom);
    if (!around.meets(box)) continue;
    if (std::any_of(own_parts.begin(), own_parts.end(), [&](const auto& own) { return own.second.meets(box); }))
      others.emplace_back(&part, box);
  }
  // Find the maximum contact depth over all pairs.
  Overlap deepest;
  std::vector<dContactGeom> touching(8);
  for (const auto& [own, own_box] : own_parts)
    for (const auto& [other, box] : others) {
      if ((own->category & other->collides_with) == 0 || (other->category & own->collides_with) == 0) continue;
      if (!own_box.meets(box)) continue;
      const int count =
          find_contacts(own->geom, other->geom, static_cast<int>(touching.size()), &touching[0], sizeof(dContactGeom));
      for (int i = 0; i < count; ++i)
        if (touching[static_cast<std::size_t>(i)].depth > deepest.depth_m)
          deepest = {other->group, touching[static_cast<std::size_t>(i)].depth};
    }
  return deepest;
}

void Collider::on_near(void* self, dGeomID first, dGeomID second) {
  if (dGeomIsSpace(first) || dGeomIsSpace(second)) {
    dSpaceCollide2(first, second, self, &Collider::on_near);
    return;
  }
  const auto number = [](dGeomID geom) {
    return static_cast<int>(reinterpret_cast<std::intptr_t>(dGeomGetData(geom)));
  };
  static_cast<Collider*>(self)->add_pair(number(first), number(second));
}

void Collider::add_pair(int first, int second) {
  if (second < first) std::swap(first, second);
  const CollisionPart& a = parts_[first];
  const CollisionPart& b = parts_[second];
  if (a.body == b.body) return;
  if (!free(a) && !free(b)) return;
  // Each part must accept the category of the other.
  if ((a.category & b.collides_with) == 0 || (b.category & a.collides_with) == 0) return;
  if (a.group == b.group && !groups_[a.group].self_collision) return;
  const std::vector<int>& joined = joined_[a.body];
  if (std::find(joined.begin(), joined.end(), b.body) != joined.end()) return;
  pairs_.push_back(static_cast<std::uint64_t>(first) << 32 | static_cast<std::uint32_t>(second));
}

void Collider::sort_pairs() {
  const std::size_t numbers = parts_.size();
  if (pairs_.size() < numbers / 4 || pairs_.size() < 64) {
    std::sort(pairs_.begin(), pairs_.end());
    return;
  }
  // Many pairs: counting sort by the second part, then by the first; half the time of std::sort with 1000 robots.
  sorted_.resize(pairs_.size());
  for (const int shift : {0, 32}) {
    starts_.assign(numbers + 1, 0);
    for (const std::uint64_t pair : pairs_) ++starts_[((pair >> shift) & 0xffffffff) + 1];
    for (std::size_t i = 1; i < numbers; ++i) starts_[i] += starts_[i - 1];
    for (const std::uint64_t pair : pairs_) sorted_[starts_[(pair >> shift) & 0xffffffff]++] = pair;
    pairs_.swap(sorted_);
  }
}

const Surface& Collider::surface_at(const CollisionPart& a, const CollisionPart& b, const dContactGeom& contact) const {
  const auto material = [&](const CollisionPart& part) {
    return part.terrain ? part.terrain->material_at(part.geom, to_eigen(contact.pos)) : part.material;
  };
  return table_.of(material(a), material(b));
}

int Collider::touch(int first, int second, dWorldID world, dJointGroupID contacts, Islands& islands) {
  const CollisionPart& part_a = parts_[first];
  const CollisionPart& part_b = parts_[second];
  const int count =
      find_contacts(part_a.geom, part_b.geom, static_cast<int>(touching_.size()), &touching_[0].geom, sizeof(dContact));
  if (count == 0) return 0;
  // Select the contact parameters, which depend on position on terrain.
  const Surface* surface = &table_.of(part_a.material, part_b.material);
  const bool by_place = part_a.terrain || part_b.terrain;
  const CollisionBody& a = bodies_[part_a.body];
  const CollisionBody& b = bodies_[part_b.body];
  const bool note = watchers_ > 0 && watched(part_a, part_b);
  // Make a contact joint for each point.
  int rows = 0;
  for (int i = 0; i < count; ++i) {
    dContact& contact = touching_[i];
    if (by_place) surface = &surface_at(part_a, part_b, contact.geom);
    rows += surface->rows;
    contact.surface = surface->parameters;
    if (by_place) follow_ground(contact);
    if (surface->friction) align_friction(contact, a, b);
    const dJointID joint = dJointCreateContact(world, contacts, &contact);
    dJointAttach(joint, a.ode, b.ode);
    if (!note) continue;
    const dContactGeom& at = contact.geom;
    // With one null body, ODE makes the other its first body.
    watched_.push_back({joint,
                        {{first, second}, to_eigen(at.pos), to_eigen(at.normal), at.depth, Vector3d::Zero()},
                        a.ode == nullptr});
  }
  islands.add_contact(a.ode ? part_a.body : -1, b.ode ? part_b.body : -1, rows);
  return count;
}

// Lets a part within the surface layer sink to its full depth in one step, so that its weight keeps it on the ground.
// Without this, ODE stops a part that has penetrated less than the surface layer from sinking further, and nothing
// returns it to that depth: where the ground curves away, the part separates within a few steps, falls and lands,
// repeatedly.
void Collider::follow_ground(dContact& contact) const {
  const double to_layer_m = surface_layer_m_ - contact.geom.depth;
  if (!(to_layer_m > 0)) return;
  contact.surface.mode |= dContactMotionN;
  contact.surface.motionN = -to_layer_m / step_s_;
}

// Aligns one friction axis with the slip, for Coulomb's bound.  ODE limits friction along two axes independently (a
// friction pyramid), which along the diagonals is up to 1.41 times too strong.  The slip is that at the end of a step
// without friction, so that a body at rest on a slope starts to slide at the right angle.
void Collider::align_friction(dContact& contact, const CollisionBody& a, const CollisionBody& b) const {
  const Vector3d at = to_eigen(contact.geom.pos);
  const auto free_velocity = [&](const CollisionBody& body) -> Vector3d {
    if (!body.ode) return Vector3d::Zero();
    Vector3d v = to_eigen(body.velocity) + to_eigen(body.angular_velocity).cross(at - to_eigen(body.position)) +
                 step_s_ * body.inverse_mass * to_eigen(dBodyGetForce(body.ode));
    if (dBodyGetGravityMode(body.ode)) v.z() -= step_s_ * gravity_mps2_;
    return v;
  };
  const Vector3d normal = to_eigen(contact.geom.normal);
  Vector3d slip = free_velocity(a) - free_velocity(b);
  slip -= slip.dot(normal) * normal;
  const double speed = slip.norm();
  if (!(speed > still_mps_)) return;
  contact.surface.mode |= dContactFDir1;
  for (int i = 0; i < 3; ++i) contact.fdir1[i] = slip[i] / speed;
}

}  // namespace sim
