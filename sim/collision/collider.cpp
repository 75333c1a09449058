// SPDX-License-Identifier: BSD-3-Clause
#include "sim/collision/collider.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/free_numbers.hpp"
#include "sim/collision/terrain_geom.hpp"
#include "sim/ode/find_contacts.hpp"
#include "sim/ode/ode_math.hpp"

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
      space_(make_space(config.space)) {
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

void Collider::find_wheels(std::span<const int> parts, const Vector3d& at_W, const Vector3d& axis_W) {
  for (const int part : parts)
    if (turns_about_its_axis(parts_[part].geom, at_W, axis_W)) parts_[part].wheel = true;
}

void Collider::load_wheels(std::span<const int> parts, double mass_kg) {
  const auto wheels = std::count_if(parts.begin(), parts.end(), [&](int part) { return parts_[part].wheel; });
  for (const int part : parts)
    if (parts_[part].wheel) parts_[part].carried_kg = mass_kg / static_cast<double>(wheels);
}

void Collider::close_group(int number) {
  Group& group = groups_[number];
  if (dSpaceGetNumGeoms(group.space.get()) > 0 && !dGeomGetSpace(reinterpret_cast<dGeomID>(group.space.get())))
    dSpaceAdd(space_.get(), reinterpret_cast<dGeomID>(group.space.get()));
  for (const dGeomID geom : group.fixed) dSpaceAdd(space_.get(), geom);
  note_places(group);
  group.fixed.clear();
}

void Collider::set_far(int number, bool far) {
  const auto space = reinterpret_cast<dGeomID>(groups_[number].space.get());
  if (dSpaceGetNumGeoms(groups_[number].space.get()) == 0) return;
  const bool is_far = dGeomGetSpace(space) == nullptr;
  if (far && !is_far) dSpaceRemove(space_.get(), space);
  if (!far && is_far) dSpaceAdd(space_.get(), space);
}

void Collider::remove_group(int number, std::span<const int> bodies, std::span<const int> parts) {
  for (const int part : parts) {
    geoms_[part].reset();  // leaves its space and its body
    parts_[part] = {};
  }
  for (const int body : bodies) {
    bodies_[body] = {};
    joined_[body].clear();
    places_.remove(body);
  }
  watchers_ -= groups_[number].watchers;
  const bool had_fixed = groups_[number].has_fixed;
  groups_[number] = {};
  discard_places(had_fixed);
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

const std::vector<Collider::Pair>& Collider::find_pairs() {
  pairs_.clear();
  dSpaceCollide(space_.get(), this, &Collider::on_near);
  for (const Group& group : groups_)
    if (group.self_collision) dSpaceCollide(group.space.get(), this, &Collider::on_near);
  return pairs_;
}

void Collider::make_contacts(std::span<const Pair> pairs, dWorldID world, Islands& islands, Making& making) const {
  making.between.clear();
  making.watched.clear();
  making.count = making.max_rows = 0;
  for (const Pair pair : pairs) touch(pair, world, islands, making);
  // ODE keeps pointers to the feedback.
  making.feedback.resize(making.watched.size());
  for (std::size_t i = 0; i < making.watched.size(); ++i)
    dJointSetFeedback(making.watched[i].joint, &making.feedback[i]);
}

void Collider::read_forces(const Making& making, std::vector<ContactReport>& reports) {
  for (std::size_t i = 0; i < making.watched.size(); ++i) {
    reports.push_back(making.watched[i].report);
    const Vector3d force_W_N = to_eigen(making.feedback[i].f1);
    reports.back().force_W_N = making.watched[i].turned ? Vector3d(-force_W_N) : force_W_N;
  }
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

const Surface& Collider::surface_at(const CollisionPart& a, const CollisionPart& b, const dContactGeom& contact) const {
  const auto material = [&](const CollisionPart& part) {
    return part.terrain ? part.terrain->material_at(part.geom, to_eigen(contact.pos)) : part.material;
  };
  return table_.of(material(a), material(b));
}

/// Finds the contact points of two parts.
int Collider::find_points(const CollisionPart& a, const CollisionPart& b, Making& making) const {
  const bool wheels = a.wheel || b.wheel;
  const int max = wheels ? static_cast<int>(making.touching.size()) : making.max_per_pair;
  int count = find_contacts(a.geom, b.geom, max, &making.touching[0].geom, sizeof(dContact));
  if (!wheels) return count;
  for (const CollisionPart* part : {&a, &b})
    if (part->wheel)
      count = put_wheel_on_its_middle(part->geom, surface_layer_m_,
                                      std::span(making.touching).first(static_cast<std::size_t>(count)));
  return std::min(count, making.max_per_pair);
}

void Collider::touch(Pair pair, dWorldID world, Islands& islands, Making& making) const {
  const int first = first_of(pair), second = second_of(pair);
  std::vector<dContact>& touching = making.touching;
  const CollisionPart& part_a = parts_[first];
  const CollisionPart& part_b = parts_[second];
  const int count = find_points(part_a, part_b, making);
  if (count == 0) return;
  // Select the contact parameters, which depend on position on terrain.
  const Surface* surface = &table_.of(part_a.material, part_b.material);
  const bool by_place = part_a.terrain || part_b.terrain;
  const CollisionBody& a = bodies_[part_a.body];
  const CollisionBody& b = bodies_[part_b.body];
  const bool between = a.ode != nullptr && b.ode != nullptr && part_a.group != part_b.group;
  const bool note = watchers_ > 0 && watched(part_a, part_b);
  const double carried_kg = std::max(part_a.carried_kg, part_b.carried_kg);
  // Make a contact joint for each point.
  int rows = 0;
  for (int i = 0; i < count; ++i) {
    dContact& contact = touching[i];
    if (by_place) surface = &surface_at(part_a, part_b, contact.geom);
    rows += surface->rows;
    contact.surface = surface->parameters;
    if (by_place) follow_ground(contact);
    if (surface->friction) align_friction(contact, a, b);
    // Between vehicles it is not pressed by its share of the weight, and crowds are solved without slip.
    if (carried_kg > 0 && !between) ease_friction_across(contact, a, b, carried_kg * std::abs(gravity_mps2_));
    const dJointID joint = dJointCreateContact(world, making.contacts.get(), &contact);
    dJointAttach(joint, a.ode, b.ode);
    if (between) making.between.push_back({joint, contact, {a.ode, b.ode}});
    if (!note) continue;
    const dContactGeom& at = contact.geom;
    // With one null body, ODE makes the other its first body.
    making.watched.push_back({joint,
                              {{first, second}, to_eigen(at.pos), to_eigen(at.normal), at.depth, Vector3d::Zero()},
                              a.ode == nullptr});
  }
  making.count += count;
  making.max_rows =
      std::max(making.max_rows, islands.add_contact(a.ode ? part_a.body : -1, b.ode ? part_b.body : -1, rows));
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

// Coulomb's friction of a sliding contact has no part across its slip s.  To first order in a velocity u across it, it
// is mu N u / |s|.  ODE's limit along that axis is mu N of its own, with which wheels that slip lengthwise would hold a
// skid-steered vehicle as if they stood.  `load_N` need not be exact: where the slip has settled, the part is zero.
void Collider::ease_friction_across(dContact& contact, const CollisionBody& a, const CollisionBody& b,
                                    double load_N) const {
  const double limit_N = contact.surface.mu * load_N;
  if ((contact.surface.mode & dContactFDir1) == 0 || !(limit_N > 0)) return;
  const Vector3d at = to_eigen(contact.geom.pos), normal = to_eigen(contact.geom.normal);
  const auto velocity = [&](const CollisionBody& body) -> Vector3d {
    if (!body.ode) return Vector3d::Zero();
    return to_eigen(body.velocity) + to_eigen(body.angular_velocity).cross(at - to_eigen(body.position));
  };
  Vector3d slip = velocity(a) - velocity(b);
  slip -= slip.dot(normal) * normal;
  const double speed = slip.norm();
  if (!(speed > still_mps_)) return;
  if ((contact.surface.mode & dContactSlip2) == 0) contact.surface.slip2 = 0;
  contact.surface.mode |= dContactSlip2;
  contact.surface.slip2 += speed / limit_N;
}

}  // namespace sim
