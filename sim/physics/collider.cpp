#include "sim/physics/collider.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/physics/ode_math.hpp"

namespace sim {
namespace {

SpaceHandle make_space(const std::string& kind) {
  dSpaceID space = nullptr;
  if (kind == "simple") {
    space = dSimpleSpaceCreate(nullptr);
  } else if (kind == "hash") {
    space = dHashSpaceCreate(nullptr);
  } else if (kind == "quadtree") {
    // What lies outside is found too, only slower.
    const dVector3 center = {0, 0, 0, 0}, extents = {1024, 1024, 1024, 0};
    space = dQuadTreeSpaceCreate(nullptr, center, extents, 7);
  } else {
    space = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
  }
  dSpaceSetCleanup(space, 0);  // geoms have owners of their own
  return SpaceHandle(space);
}

}  // namespace

Collider::Collider(const PhysicsConfig& config, ContactTable table)
    : table_(std::move(table)),
      step_s_(config.step_s),
      gravity_mps2_(config.gravity_mps2),
      still_mps_(std::max(1e-6, 0.01 * config.step_s * std::abs(config.gravity_mps2))),
      space_(make_space(config.space)),
      touching_(static_cast<std::size_t>(config.max_contacts_per_pair)) {}

int Collider::add_group(bool self_collision) {
  Group& group = groups_.emplace_back();
  group.space = make_space("simple");
  group.self_collision = self_collision;
  dSpaceSetSublevel(group.space.get(), 1);
  dGeomSetCategoryBits(reinterpret_cast<dGeomID>(group.space.get()), 0);
  dGeomSetCollideBits(reinterpret_cast<dGeomID>(group.space.get()), 0);
  return static_cast<int>(groups_.size()) - 1;
}

int Collider::add_part(const CollisionPart& part, GeomHandle geom, bool is_moving) {
  const int number = static_cast<int>(parts_.size());
  parts_.push_back(part);
  parts_.back().geom = geom.get();
  dGeomSetData(geom.get(), reinterpret_cast<void*>(static_cast<std::intptr_t>(number)));
  dGeomSetCategoryBits(geom.get(), part.category);
  // Fixed parts look for nobody: so the space drops pairs of two fixed parts at once.
  const unsigned long collides = is_moving ? part.collides_with : 0;
  dGeomSetCollideBits(geom.get(), collides);
  Group& group = groups_[part.group];
  if (is_moving) {
    const auto as_geom = reinterpret_cast<dGeomID>(group.space.get());
    dGeomSetCategoryBits(as_geom, dGeomGetCategoryBits(as_geom) | part.category);
    dGeomSetCollideBits(as_geom, dGeomGetCollideBits(as_geom) | collides);
    dSpaceAdd(group.space.get(), geom.get());
  } else {
    // Straight into the world's space: one box around all of a harbour would keep nothing apart.
    group.fixed.push_back(geom.get());
  }
  geoms_.push_back(std::move(geom));
  return number;
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

int Collider::collide(dWorldID world, dJointGroupID contacts, Islands& islands) {
  pairs_.clear();
  dSpaceCollide(space_.get(), this, &Collider::on_near);
  for (const Group& group : groups_)
    if (group.self_collision) dSpaceCollide(group.space.get(), this, &Collider::on_near);
  sort_pairs();
  int count = 0;
  for (const std::uint64_t pair : pairs_)
    count += touch(static_cast<int>(pair >> 32), static_cast<int>(pair & 0xffffffff), world, contacts, islands);
  return count;
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
  if (!moving(a) && !moving(b)) return;
  // Both must want the contact.
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
  // Many pairs: counting sort by the second part, then by the first; half the time of std::sort at 1000
  // robots.
  sorted_.resize(pairs_.size());
  for (const int shift : {0, 32}) {
    starts_.assign(numbers + 1, 0);
    for (const std::uint64_t pair : pairs_) ++starts_[((pair >> shift) & 0xffffffff) + 1];
    for (std::size_t i = 1; i < numbers; ++i) starts_[i] += starts_[i - 1];
    for (const std::uint64_t pair : pairs_) sorted_[starts_[(pair >> shift) & 0xffffffff]++] = pair;
    pairs_.swap(sorted_);
  }
}

int Collider::touch(int first, int second, dWorldID world, dJointGroupID contacts, Islands& islands) {
  const CollisionPart& part_a = parts_[first];
  const CollisionPart& part_b = parts_[second];
  const int count =
      dCollide(part_a.geom, part_b.geom, static_cast<int>(touching_.size()), &touching_[0].geom, sizeof(dContact));
  if (count == 0) return 0;
  const Surface& surface = table_.of(part_a.material, part_b.material);
  const CollisionBody& a = bodies_[part_a.body];
  const CollisionBody& b = bodies_[part_b.body];
  for (int i = 0; i < count; ++i) {
    dContact& contact = touching_[i];
    contact.surface = surface.parameters;
    if (surface.friction) align_friction(contact, a, b);
    dJointAttach(dJointCreateContact(world, contacts, &contact), a.ode, b.ode);
  }
  islands.add_contact(a.ode ? part_a.body : -1, b.ode ? part_b.body : -1, count * surface.rows);
  return count;
}

// ODE bounds friction along two axes by itself (a pyramid), which across the corners is up to 1.41 times too
// strong. With one axis along the slip the bound is Coulomb's.  The slip meant is the one that a step without
// friction would end with, so that a body at rest on a slope starts to slide at the right angle.
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
