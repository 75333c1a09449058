// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/physics_world.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "sim/ode/ode_math.hpp"
#include "sim/physics/physics_world_impl.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

PhysicsWorld::Impl::Impl(const PhysicsConfig& config, ContactTable table, std::uint64_t seed)
    : settings{config, seed},
      shards(settings, groups, collider, islands, moved),
      collider(config, std::move(table)),
      far_groups(groups, collider, moves),
      leaps(config.step_s, groups, far_groups),
      moved(config, collider, far_groups, leaps),
      singles(settings, groups, shards, far_groups, moved),
      scene(make_world_scene(config.rays, moves)) {
  moves.bring_parts = [this] { singles.bring_parts(); };
}

void PhysicsWorld::Impl::step(std::int64_t step_number) {
  islands.begin_step();
  singles.list_again();
  far_groups.update();
  singles.mark_near();
  const std::vector<Collider::Pair>& pairs = collider.find_pairs();
  shards.bring_together(pairs, step_number);
  singles.list_again();
  shards.give_pairs(pairs);
  const bool single_out = singles.step(threads.get());
  const bool other_out = shards.step(threads.get(), step_number);
  report.collect(shards.stepped(), islands.max_rows_of_joints());
  if (single_out || other_out) moved.throw_first_fault(groups, step_number);
  StepReport::throw_first_fault(shards.stepped());
  ++moves.moving;
  collider.note_positions(moves);
  leaps.find();
}

void PhysicsWorld::Impl::use_gravity(double gravity_mps2) {
  settings.gravity_mps2 = gravity_mps2;
  collider.set_gravity(gravity_mps2);
  shards.set_gravity();
}

// The world as a whole.

PhysicsWorld::PhysicsWorld(const PhysicsConfig& config, const std::vector<MaterialConfig>& materials,
                           const std::vector<ContactConfig>& contacts, const std::vector<std::string>& categories,
                           std::uint64_t seed) {
  start_again(config, materials, contacts, categories, seed);
}

void PhysicsWorld::start_again(const PhysicsConfig& config, const std::vector<MaterialConfig>& materials,
                               const std::vector<ContactConfig>& contacts, const std::vector<std::string>& categories,
                               std::uint64_t seed) {
  discard();
  start_ode();
  impl_ = std::make_unique<Impl>(config, ContactTable(materials, contacts), seed);
  add_categories(categories);
  use_threads(threads_);
}

PhysicsWorld::~PhysicsWorld() {
  discard();
}

void PhysicsWorld::discard() {
  if (!impl_ || !impl_->report.broken()) return impl_.reset();
  // A world in which a step failed triggers ODE's asserts when it is destroyed.  It is therefore kept, reachable for
  // leak checkers.
  impl_->scene.reset();
  static std::mutex mutex;
  static std::vector<Impl*>& left_behind = *new std::vector<Impl*>;  // also after the end of main()
  const std::lock_guard lock(mutex);
  left_behind.push_back(impl_.release());
}

void PhysicsWorld::visit_state(StateArchive& archive) {
  double gravity = gravity_mps2();
  bool was_set = impl_->gravity_was_set;
  archive.unhashed(was_set);
  archive(gravity);
  if (archive.restoring()) {
    if (!std::isfinite(gravity)) archive.fail("gravity that is not finite");
    impl_->use_gravity(was_set ? gravity : impl_->settings.config.gravity_mps2);
    impl_->gravity_was_set = was_set;
    ++impl_->moves.moving;
    impl_->leaps.plan_anew();
  }
  impl_->report.visit_state(archive, impl_->parts);
}

void PhysicsWorld::add_surfaces(const std::vector<MaterialConfig>& materials,
                                const std::vector<ContactConfig>& contacts) {
  impl_->collider.add_surfaces(materials, contacts);
}
void PhysicsWorld::add_categories(const std::vector<std::string>& names) {
  impl_->parts.add_categories(names);
}

void PhysicsWorld::set_gravity(double gravity_mps2) {
  if (!std::isfinite(gravity_mps2)) throw std::invalid_argument("gravity is not finite");
  impl_->use_gravity(gravity_mps2);
  impl_->gravity_was_set = true;
}
double PhysicsWorld::gravity_mps2() const {
  return impl_->settings.gravity_mps2;
}

void PhysicsWorld::use_threads(int threads) {
  threads_ = threads;
  impl_->threads = threads == 1 ? nullptr : std::make_unique<ThreadPool>(threads);
}

void PhysicsWorld::step(std::int64_t step_number) {
  impl_->step(step_number);
}

// Groups.

int PhysicsWorld::add_group(const std::string& name, bool self_collision) {
  const int number = impl_->groups.add(name);
  impl_->scene->add_group(number);
  impl_->collider.add_group(number, self_collision);
  return number;
}

Body& PhysicsWorld::add_body(int group, const BodyConfig& config, const Pose& X_WV, Motion motion) {
  Impl& all = *impl_;
  Group& owner = all.groups.at(group);
  auto owned =
      std::make_unique<SteppedBody>(owner.name + "/" + config.name, all.groups.next_body(), group, motion, all.moves);
  SteppedBody& body = *owned;
  const bool moving = motion != Motion::fixed;
  if (moving) body.create(all.shards.world_of(group));
  for (const int part : all.parts.add(body, config, all.collider, *all.scene)) {
    owner.parts.push_back(part);
    all.shards.add_part(part, group, !moving);
  }
  all.collider.add_body(body.number(), body.for_collider());
  all.islands.add_body(body.number());
  const bool noted = all.collider.has_noted_positions(all.moves);
  body.set_pose(X_WV * make_pose(config.position_m, config.rpy_rad));
  if (noted) all.collider.note_positions(all.moves);  // close_group() notes that of this body
  all.groups.add_body(std::move(owned));
  if (moving) all.shards.note_change(group);
  return body;
}

Joint& PhysicsWorld::add_joint(int group, const JointConfig& config, Body& first, Body* second, const Pose& X_WV) {
  Impl& all = *impl_;
  Group& owner = all.groups.at(group);
  assert(first.group() == group && (!second || second->group() == group));  // else a removal leaves a dangling joint
  const std::string name = owner.name + "/" + config.name;
  const auto is_free = [&](const Body* body) { return body != nullptr && !body->fixed() && !body->kinematic(); };
  const auto ode_of = [&](const Body* body) { return body ? all.groups.body(body->number()).ode() : nullptr; };
  const dBodyID a = ode_of(&first), b = ode_of(second);
  // Check that ODE can make this joint.
  if (!is_free(&first) && !is_free(second))
    throw_config_error({}, "joint '" + name + "'", "joins two bodies that are fixed or kinematic");
  if (config.type == JointType::hinge2 && (!a || !b))
    throw_config_error({}, "joint '" + name + "'", "hinge2 needs two bodies that move");
  if (second == &first) throw_config_error({}, "joint '" + name + "'", "joins a body to itself");
  auto owned = std::make_unique<SteppedJoint>(dBodyGetWorld(a ? a : b), name, config, a, b, X_WV);
  SteppedJoint& joint = *owned;
  // Without finite rotation a wheel turns too little in each step: 7 % at 100 rad/s and 10 ms.
  if (joint_info(config.type).carries_a_wheel) {
    dBodySetFiniteRotationMode(b ? b : a, 1);
    const auto is_joined = [&](int part) {
      return all.parts[part].body == first.number() || (second && all.parts[part].body == second->number());
    };
    std::vector<int> own;
    std::copy_if(owner.parts.begin(), owner.parts.end(), std::back_inserter(own), is_joined);
    const Vector3d& axis_V = (config.type == JointType::hinge2 ? config.axis2 : config.axis1).axis;
    all.collider.find_wheels(own, X_WV * config.anchor_m, X_WV.linear() * axis_V);
  }
  all.shards.note_change(group);
  all.islands.add_joint(a ? first.number() : -1, b ? second->number() : -1, joint.max_rows());
  if (second) all.collider.join(first.number(), second->number());
  all.groups.add_joint(owner, std::move(owned));
  return joint;
}

void PhysicsWorld::close_group(int group) {
  Impl& all = *impl_;
  const Group& closed = all.groups.at(group);
  double mass_kg = 0;
  for (const int body : closed.bodies) mass_kg += all.groups.body(body).mass_kg();
  all.collider.load_wheels(closed.parts, mass_kg);
  all.collider.close_group(group);
  all.leaps.plan(closed);
  all.far_groups.note(group);
  all.scene->close_group(group);
}

void PhysicsWorld::remove_group(int group) {
  Impl& all = *impl_;
  const Group& removed = all.groups.at(group);
  const int shard = removed.shard;
  all.report.remove(group, all.parts);
  all.far_groups.note(group);
  all.far_groups.remove(group);
  all.shards.leave(group);
  all.scene->remove_group(group, removed.parts);
  all.groups.destroy_joints(removed);
  all.collider.remove_group(group, removed.bodies, removed.parts);
  all.islands.remove_bodies(removed.bodies);
  all.groups.destroy_bodies(removed);
  if (shard >= 0) all.shards.destroy_if_empty(shard);
  all.parts.remove(removed.parts);
  all.groups.remove(group);
}

void PhysicsWorld::move_group(int group, const Pose& X_move_W, bool keep_velocity) {
  const Group& moved = impl_->groups.at(group);
  const Matrix3d turn_W = X_move_W.linear();
  for (const int number : moved.bodies) {
    Body& body = impl_->groups.body(number);
    const Vector3d v_WB_W = body.v_WB_W(), w_WB_W = body.w_WB_W();
    body.set_pose(X_move_W * body.X_WB());
    if (keep_velocity)
      body.set_velocity_W(turn_W * v_WB_W, turn_W * w_WB_W);
    else
      body.set_velocity_W(Vector3d::Zero(), Vector3d::Zero());
  }
  for (const int number : moved.joints) impl_->groups.joint(number).move_world_side(X_move_W);
}

GroupNumbers PhysicsWorld::numbers_of(int group) const {
  const Group& owner = impl_->groups.at(group);
  return {group, owner.bodies, owner.parts, owner.joints};
}

void PhysicsWorld::prescribe(const GroupNumbers& numbers) {
  impl_->groups.prescribe(numbers);
  impl_->parts.prescribe(numbers.parts);
}

bool PhysicsWorld::as_prescribed() const {
  return impl_->groups.as_prescribed() && impl_->parts.as_prescribed();
}

std::vector<JointPlace> PhysicsWorld::joint_places(int group) const {
  std::vector<JointPlace> places;
  for (const int number : impl_->groups.at(group).joints)
    if (const auto& made = impl_->groups.joint(number).origin(); made.to_world)
      places.push_back({made.X_WV, made.X_WC});
  return places;
}

void PhysicsWorld::make_joints_again(int group, std::span<const JointPlace> places) {
  if (places.size() != joint_places(group).size()) throw std::out_of_range("other joints to the world");
  auto place = places.begin();
  for (const int number : impl_->groups.at(group).joints) {
    SteppedJoint& joint = impl_->groups.joint(number);
    if (!joint.origin().to_world) continue;
    joint.make_again(place->X_WV, place->X_WC);
    ++place;
  }
}

// What is asked of it.

const std::string& PhysicsWorld::group_name(int group) const {
  return impl_->groups.name(group);
}
bool PhysicsWorld::anchored(int group) const {
  return impl_->groups.at(group).anchored;
}
std::span<const std::unique_ptr<Body>> PhysicsWorld::bodies() const {
  return impl_->groups.bodies();
}
std::span<const std::unique_ptr<Joint>> PhysicsWorld::joints() const {
  return impl_->groups.joints();
}
std::span<const PartInfo> PhysicsWorld::parts() const {
  return impl_->parts.all();
}

std::optional<int> PhysicsWorld::find_part(int group, std::string_view body_slash_part) const {
  const Group& owner = impl_->groups.at(group);
  for (const int part : owner.parts)
    if (std::string_view(impl_->parts[part].name).substr(owner.name.size() + 1) == body_slash_part) return part;
  return std::nullopt;
}

int PhysicsWorld::materials() const {
  return impl_->collider.table().materials();
}
const MaterialConfig& PhysicsWorld::material(int number) const {
  return impl_->collider.table().material(number);
}
std::uint32_t PhysicsWorld::category_bit(const std::string& name) const {
  return impl_->parts.category_bit(name);
}
Pose PhysicsWorld::X_WP(int part) const {
  const PartInfo& info = impl_->parts[part];
  return impl_->groups.body(info.body).X_WB() * info.X_BP;
}

std::optional<Eigen::AlignedBox3d> PhysicsWorld::bounds_W(int part) const {
  if (impl_->parts[part].plane) return std::nullopt;
  if (const CollisionTerrain* ground = impl_->parts.terrain(part)) {
    // The geom extends far below the surface, so use the vertices.
    Eigen::AlignedBox3d box;
    const Pose X_WP_now = X_WP(part);
    for (const Vector3d& vertex : ground->mesh.vertices_m) box.extend(X_WP_now * vertex);
    return box;
  }
  impl_->singles.bring_parts();
  dReal sides[6];
  dGeomGetAABB(impl_->collider.parts()[static_cast<std::size_t>(part)].geom, sides);
  return Eigen::AlignedBox3d(Vector3d(sides[0], sides[2], sides[4]), Vector3d(sides[1], sides[3], sides[5]));
}

std::pair<std::string, double> PhysicsWorld::deepest_overlap(int group) const {
  impl_->singles.bring_parts();
  const Collider::Overlap overlap = impl_->collider.deepest_overlap(group, impl_->groups.at(group).parts, impl_->moves);
  return {overlap.group < 0 ? "" : group_name(overlap.group), overlap.depth_m};
}

std::vector<std::string> PhysicsWorld::ground_warnings() const {
  return impl_->parts.ground_warnings(impl_->groups, impl_->collider);
}
const Scene& PhysicsWorld::scene() const {
  return *impl_->scene;
}
double PhysicsWorld::step_s() const {
  return impl_->settings.config.step_s;
}
std::vector<Leap> PhysicsWorld::take_leaps() {
  return impl_->leaps.take();
}

void PhysicsWorld::watch_contacts(int group) {
  impl_->groups.at(group);
  impl_->collider.watch(group);
}
void PhysicsWorld::unwatch_contacts(int group) {
  impl_->groups.at(group);
  impl_->collider.unwatch(group);
}
std::span<const ContactReport> PhysicsWorld::contacts() const {
  return impl_->report.contacts();
}
const StepCounts& PhysicsWorld::last_step() const {
  return impl_->report.counts();
}
std::int64_t PhysicsWorld::quick_steps() const {
  return impl_->report.quick_steps();
}

IslandInfo PhysicsWorld::largest_island() const {
  constexpr std::size_t max_names = 1000;
  IslandInfo found;
  int first = -1;
  Islands& islands = impl_->islands;
  impl_->groups.for_each_moving([&](const SteppedBody& body) {
    const int rows = islands.knows(body.number()) ? islands.rows_of(body.number()) : 0;
    if (rows > found.rows) found.rows = rows, first = islands.first_of(body.number());
  });
  for (const auto& body : bodies()) {
    if (first < 0 || !body || body->fixed() || !islands.knows(body->number())) continue;
    if (islands.first_of(body->number()) != first) continue;
    ++found.body_count;
    if (found.bodies.size() < max_names) found.bodies.push_back(body->name());
  }
  return found;
}

}  // namespace sim
