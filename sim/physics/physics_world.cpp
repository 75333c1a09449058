#include "sim/physics/physics_world.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sim/physics/collider.hpp"
#include "sim/physics/free_numbers.hpp"
#include "sim/physics/islands.hpp"
#include "sim/physics/ode_library.hpp"
#include "sim/physics/ode_math.hpp"
#include "sim/physics/part_shape.hpp"
#include "sim/scene/ode_scene.hpp"

namespace sim {

// Members are destroyed from the last to the first: joints and bodies before their world.
struct PhysicsWorld::Impl {
  /// What belongs to a group, by number.
  struct Group {
    std::string name;
    bool in_use = false;
    std::vector<int> bodies, parts, joints;
  };

  Impl(const PhysicsConfig& config_, ContactTable table, std::uint64_t seed_)
      : config(config_), seed(seed_), collider(config_, std::move(table)) {}

  PhysicsConfig config;
  std::uint64_t seed;
  std::vector<std::string> categories = {"solid"};
  MeshCache meshes;
  // ODE's default threading is shared by all worlds of the process; two worlds in two threads then abort.
  ThreadingHandle threading{dThreadingAllocateSelfThreadedImplementation()};
  WorldHandle world{dWorldCreate()};
  JointGroupHandle contacts{dJointGroupCreate(0)};
  Collider collider;
  Islands islands;
  std::vector<Group> groups;
  std::vector<PartInfo> parts;
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<std::unique_ptr<Joint>> joints;
  FreeNumbers group_numbers, part_numbers, body_numbers, joint_numbers;
  // What a step goes through, in order of groups.
  std::vector<Body*> moving;                             // free and kinematic
  std::vector<std::pair<int, Joint*>> joints_with_axes;  // with their groups
  std::vector<Body*> kinematic;
  std::vector<Joint*> measured_joints;
  std::vector<ContactReport> contact_reports;
  double gravity_mps2 = config.gravity_mps2;
  SceneMoves moves;
  std::unique_ptr<OdeScene> scene;
  StepCounts counts;
  std::int64_t quick_steps = 0;
  bool broken = false;  ///< ODE threw in mid-step

  std::uint32_t category_bit(const std::string& name) const;
  std::uint32_t category_bits(const std::vector<std::string>& names) const;
  Group& group(int number);
  void attach_ode_body(Body& body);
  void add_parts(Body& body, const BodyConfig& config);
  void add_part(Body& body, const BodyConfig& config, std::size_t index, GeomHandle geom);
  void forget_in_lists(int group_number);
  void set_mass(Body& body, const BodyConfig& config, const dMass& total);
  void collide();
  void solve(std::int64_t step_number);
  void finish(std::int64_t step_number);
  bool out_of_bounds(const Body& body) const;
  [[noreturn]] void fault(const Body& body, std::int64_t step_number) const;
};

namespace {

std::string part_name(const Body& body, const PartConfig& part, std::size_t index) {
  return body.name() + "/" + (part.name.empty() ? std::to_string(index + 1) : part.name);
}

/// A seed for QuickStep's shuffle that depends on nothing but the world's seed and the step.
unsigned long step_seed(std::uint64_t seed, std::int64_t step_number) {
  StateHash hash;
  hash.add(seed);
  hash.add(step_number);
  return static_cast<unsigned long>(hash.value() >> 32);
}

}  // namespace

PhysicsWorld::PhysicsWorld(const PhysicsConfig& config, const std::vector<MaterialConfig>& materials,
                           const std::vector<ContactConfig>& contacts, const std::vector<std::string>& categories,
                           std::uint64_t seed) {
  start_ode();
  impl_ = std::make_unique<Impl>(config, ContactTable(materials, contacts), seed);
  for (const std::string& name : categories)
    if (name != "solid") impl_->categories.push_back(name);
  if (impl_->categories.size() > 31) throw std::length_error("more than 31 categories of parts");
  const dWorldID world = impl_->world.get();
  dWorldSetStepThreadingImplementation(world, dThreadingImplementationGetFunctions(impl_->threading.get()),
                                       impl_->threading.get());
  dWorldSetGravity(world, 0, 0, -config.gravity_mps2);
  dWorldSetERP(world, config.erp);
  dWorldSetCFM(world, config.cfm);
  dWorldSetContactMaxCorrectingVel(world, config.contact_max_correcting_velocity_mps);
  dWorldSetContactSurfaceLayer(world, config.contact_surface_layer_m);
  dWorldSetQuickStepNumIterations(world, config.quick_iterations);
  // ODE's auto-disable keeps hidden counters, which a snapshot could not restore.
  dWorldSetAutoDisableFlag(world, 0);
  impl_->scene = std::make_unique<OdeScene>(impl_->moves);
}

PhysicsWorld::~PhysicsWorld() {
  if (!impl_ || !impl_->broken) return;
  // A world that was left in mid-step trips ODE's asserts when it is destroyed.  It stays, where leak checkers see it.
  static std::vector<Impl*> left_behind;
  left_behind.push_back(impl_.release());
}

int PhysicsWorld::add_group(const std::string& name, bool self_collision) {
  const int number = impl_->group_numbers.take();
  slot(impl_->groups, number) = {name, true, {}, {}, {}};
  impl_->scene->add_group(number);
  impl_->collider.add_group(number, self_collision);
  return number;
}

PhysicsWorld::Impl::Group& PhysicsWorld::Impl::group(int number) {
  if (number < 0 || number >= static_cast<int>(groups.size()) || !groups[number].in_use)
    throw std::out_of_range("no group " + std::to_string(number));
  return groups[number];
}

Body& PhysicsWorld::add_body(int group, const BodyConfig& config, const Pose& X_WV, Motion motion) {
  Impl::Group& owner = impl_->group(group);
  std::unique_ptr<Body> owned(new Body);
  Body& body = *owned;
  body.name_ = owner.name + "/" + config.name;
  body.number_ = impl_->body_numbers.next();  // taken when all went well
  body.group_ = group;
  body.motion_ = motion;
  body.moves_ = &impl_->moves;
  if (motion != Motion::fixed) impl_->attach_ode_body(body);
  impl_->add_parts(body, config);
  impl_->collider.add_body(body.number_, {body.free(), body.ode_.get(), body.p_WC_, body.v_WC_W_, body.w_WB_W_,
                                          body.mass_kg_ > 0 ? 1 / body.mass_kg_ : 0});
  impl_->islands.add_body(body.number_);
  const auto by_group = [](int number, const Body* other) { return number < other->group_; };
  const auto keep_order = [&](std::vector<Body*>& bodies) {
    bodies.insert(std::upper_bound(bodies.begin(), bodies.end(), group, by_group), &body);
  };
  if (motion != Motion::fixed) keep_order(impl_->moving);
  if (motion == Motion::kinematic) keep_order(impl_->kinematic);
  body.set_pose(X_WV * make_pose(config.position_m, config.rpy_rad));
  owner.bodies.push_back(impl_->body_numbers.take());
  slot(impl_->bodies, body.number_) = std::move(owned);
  return body;
}

void PhysicsWorld::Impl::attach_ode_body(Body& body) {
  const dBodyID ode = dBodyCreate(world.get());
  body.ode_.reset(ode);
  body.p_WC_ = dBodyGetPosition(ode);
  body.R_WB_ = dBodyGetRotation(ode);
  body.v_WC_W_ = dBodyGetLinearVel(ode);
  body.w_WB_W_ = dBodyGetAngularVel(ode);
  // Our own gyroscopic torque, see Body::add_gyroscopic_torque.
  dBodySetGyroscopicMode(ode, 0);
  if (!body.kinematic()) return;
  body.gyroscopic_ = false;
  dBodySetKinematic(ode);
  dBodySetGravityMode(ode, 0);
  // A step then turns it by exactly its angular velocity.
  dBodySetFiniteRotationMode(ode, 1);
}

void PhysicsWorld::Impl::add_parts(Body& body, const BodyConfig& config_) {
  // Checked and made first, added after: an exception leaves no half body behind.
  std::vector<GeomHandle> geoms;
  dMass total;
  dMassSetZero(&total);
  for (std::size_t i = 0; i < config_.parts.size(); ++i) {
    const PartConfig& part = config_.parts[i];
    const std::string who =
        "body '" + body.name() + "': part " + (part.name.empty() ? std::to_string(i + 1) : "'" + part.name + "'");
    if (part.shape == "plane" && !body.fixed())
      throw_config_error(part.place, who, "a plane can only be part of a fixed body");
    const CollisionMesh* mesh = part.shape == "mesh" ? &meshes.get(part, who) : nullptr;
    geoms.push_back(make_geom(part, mesh));
    if (!body.free()) continue;
    const dMass mass = part_mass(part, mesh, who);
    if (mass.mass > 0) dMassAdd(&total, &mass);
  }
  if (body.free()) set_mass(body, config_, total);
  for (std::size_t i = 0; i < geoms.size(); ++i) add_part(body, config_, i, std::move(geoms[i]));
}

void PhysicsWorld::Impl::add_part(Body& body, const BodyConfig& config_, std::size_t index, GeomHandle owned) {
  const PartConfig& part = config_.parts[index];
  const dGeomID geom = owned.get();
  const Pose X_BG = make_pose(part.position_m, part.rpy_rad);
  if (body.fixed()) {
    body.fixed_geoms_.push_back({geom, X_BG, part.shape == "plane"});
  } else {
    // An offset of nothing would still cost a product of matrices in each step.
    const Vector3d p_CG = X_BG.translation() - body.p_BC_;
    dGeomSetBody(geom, body.ode_.get());
    if (!p_CG.isZero(0)) dGeomSetOffsetPosition(geom, p_CG.x(), p_CG.y(), p_CG.z());
    dQuaternion q;
    to_ode(to_quaternion(X_BG.linear()), q);
    if (!part.rpy_rad.isZero(0)) dGeomSetOffsetQuaternion(geom, q);
  }
  const CollisionPart collision{geom,
                                body.number_,
                                body.group_,
                                collider.table().number_of(part.material),
                                category_bit(part.category),
                                category_bits(part.collides_with)};
  const int number = part_numbers.take();
  groups[body.group_].parts.push_back(number);
  slot(parts, number) = {part_name(body, part, index), body.group_, body.number_, collision.material,
                         collision.category};
  scene->add_part(number, geom, body.group_, collision.category, !body.fixed());
  collider.add_part(number, collision, std::move(owned), body.motion_);
}

void PhysicsWorld::Impl::set_mass(Body& body, const BodyConfig& config_, const dMass& total) {
  if (!(total.mass > 0)) {
    const SourcePlace place = config_.parts.empty() ? config_.place : config_.parts.front().place;
    throw_config_error(place, "body '" + body.name() + "'", "has no mass: give a part mass_kg or density_kgpm3");
  }
  dMass mass = total;
  body.mass_kg_ = mass.mass;
  body.p_BC_ = to_eigen(mass.c);
  dMassTranslate(&mass, -mass.c[0], -mass.c[1], -mass.c[2]);
  mass.c[0] = mass.c[1] = mass.c[2] = 0;  // exactly, or ODE aborts
  body.inertia_C_B_ = rotation_to_eigen(mass.I);
  // Spheres and cubes turn the same about any axis: no gyroscopic torque.
  const double mean = body.inertia_C_B_.trace() / 3;
  body.gyroscopic_ = !body.inertia_C_B_.isApprox(mean * Matrix3d::Identity(), 1e-12);
  dBodySetMass(body.ode_.get(), &mass);
}

Joint& PhysicsWorld::add_joint(int group, const JointConfig& config, Body& first, Body* second, const Pose& X_WV) {
  Impl::Group& owner = impl_->group(group);
  assert(first.group_ == group && (!second || second->group_ == group));  // or a removal would leave half a joint
  const std::string name = owner.name + "/" + config.name;
  const dBodyID a = first.ode_.get(), b = second ? second->ode_.get() : nullptr;
  if (!first.free() && !(second && second->free()))
    throw_config_error({}, "joint '" + name + "'", "joins two bodies that are fixed or kinematic");
  if (config.type == "hinge2" && (!a || !b))
    throw_config_error({}, "joint '" + name + "'", "hinge2 needs two bodies that move");
  if (second == &first) throw_config_error({}, "joint '" + name + "'", "joins a body to itself");
  std::unique_ptr<Joint> owned(new Joint(impl_->world.get(), name, config, a, b, X_WV));
  Joint& joint = *owned;
  // Without it a wheel turns too little in each step: 7 % at 100 rad/s and 10 ms.
  if (config.type == "hinge" || config.type == "hinge2") dBodySetFiniteRotationMode(b ? b : a, 1);
  impl_->islands.add_joint(a ? first.number_ : -1, b ? second->number_ : -1, joint.max_rows());
  if (second) impl_->collider.join(first.number_, second->number_);
  joint.measured_joints_ = &impl_->measured_joints;
  auto& with_axes = impl_->joints_with_axes;
  const auto by_group = [](int number, const auto& other) { return number < other.first; };
  if (joint.axes() > 0)
    with_axes.emplace(std::upper_bound(with_axes.begin(), with_axes.end(), group, by_group), group, &joint);
  owner.joints.push_back(impl_->joint_numbers.take());
  slot(impl_->joints, owner.joints.back()) = std::move(owned);
  return joint;
}

void PhysicsWorld::close_group(int group) {
  impl_->collider.close_group(group);
  impl_->scene->close_group(group);
}

void PhysicsWorld::remove_group(int group) {
  Impl& all = *impl_;
  Impl::Group& gone = all.group(group);
  all.forget_in_lists(group);
  all.scene->remove_group(group, gone.parts);
  for (const int joint : gone.joints) all.joints[joint].reset();
  all.collider.remove_group(group, gone.bodies, gone.parts);
  all.islands.remove_bodies(gone.bodies);
  for (const int body : gone.bodies) all.bodies[body].reset();
  for (const int part : gone.parts) all.parts[part] = {};
  for (const int number : gone.joints) all.joint_numbers.give_back(number);
  for (const int number : gone.bodies) all.body_numbers.give_back(number);
  for (const int number : gone.parts) all.part_numbers.give_back(number);
  gone = {};
  all.group_numbers.give_back(group);
}

/// Takes a group's bodies and joints out of the lists that a step goes through.
void PhysicsWorld::Impl::forget_in_lists(int group_number) {
  const auto in_group = [&](const Body* body) { return body->group_ == group_number; };
  std::erase_if(moving, in_group);
  std::erase_if(kinematic, in_group);
  std::erase_if(joints_with_axes, [&](const auto& joint) { return joint.first == group_number; });
  for (const int joint : groups[group_number].joints) std::erase(measured_joints, joints[joint].get());
  std::erase_if(contact_reports, [&](const ContactReport& contact) {
    return parts[contact.parts[0]].group == group_number || parts[contact.parts[1]].group == group_number;
  });
}

void PhysicsWorld::move_group(int group, const Pose& X_move_W, bool keep_velocity) {
  const Impl::Group& moved = impl_->group(group);
  const Matrix3d turn_W = X_move_W.linear();
  for (const int number : moved.bodies) {
    Body& body = *impl_->bodies[number];
    const Vector3d v_WB_W = body.v_WB_W(), w_WB_W = body.w_WB_W();
    body.set_pose(X_move_W * body.X_WB());
    if (keep_velocity)
      body.set_velocity_W(turn_W * v_WB_W, turn_W * w_WB_W);
    else
      body.set_velocity_W(Vector3d::Zero(), Vector3d::Zero());
  }
  for (const int number : moved.joints) impl_->joints[number]->move_world_side(X_move_W);
}

void PhysicsWorld::add_surfaces(const std::vector<MaterialConfig>& materials,
                                const std::vector<ContactConfig>& contacts) {
  impl_->collider.add_surfaces(materials, contacts);
}

void PhysicsWorld::add_categories(const std::vector<std::string>& names) {
  std::vector<std::string> all = impl_->categories;
  for (const std::string& name : names)
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  if (all.size() > 31) throw std::length_error("more than 31 categories of parts");
  impl_->categories = std::move(all);
}

void PhysicsWorld::set_gravity(double gravity_mps2) {
  if (!std::isfinite(gravity_mps2)) throw std::invalid_argument("gravity is not finite");
  impl_->gravity_mps2 = gravity_mps2;
  impl_->collider.set_gravity(gravity_mps2);
  dWorldSetGravity(impl_->world.get(), 0, 0, -gravity_mps2);
}

double PhysicsWorld::gravity_mps2() const {
  return impl_->gravity_mps2;
}

void PhysicsWorld::watch_contacts(int group) {
  impl_->group(group);
  impl_->collider.watch(group);
}
void PhysicsWorld::unwatch_contacts(int group) {
  impl_->group(group);
  impl_->collider.unwatch(group);
}
std::span<const ContactReport> PhysicsWorld::contacts() const {
  return impl_->contact_reports;
}

std::optional<int> PhysicsWorld::find_part(int group, std::string_view body_slash_part) const {
  const Impl::Group& owner = impl_->group(group);
  for (const int part : owner.parts)
    if (std::string_view(impl_->parts[part].name).substr(owner.name.size() + 1) == body_slash_part) return part;
  return std::nullopt;
}

void PhysicsWorld::step(std::int64_t step_number) {
  try {
    impl_->collide();
    impl_->solve(step_number);
  } catch (const PhysicsFault& error) {
    impl_->broken = true;
    for (const Body* body : impl_->moving)
      if (impl_->out_of_bounds(*body)) impl_->fault(*body, step_number);
    throw PhysicsFault(std::string(error.what()) + " at step " + std::to_string(step_number));
  }
  ++impl_->moves.moving;
  impl_->finish(step_number);
}

void PhysicsWorld::Impl::collide() {
  for (Body* body : kinematic) body->begin_kinematic_step();
  islands.begin_step();
  counts.contacts = collider.collide(world.get(), contacts.get(), islands);
  counts.largest_island_rows = islands.largest_rows();
}

void PhysicsWorld::Impl::solve(std::int64_t step_number) {
  const double step_s = config.step_s;
  for (Body* body : moving)
    if (body->gyroscopic_) body->add_gyroscopic_torque(step_s);
  for (Joint* joint : measured_joints) joint->note_before_step();
  // WorldStep is exact and costs the cube of an island's rows; the rows decide, never the time it takes.
  const bool too_large = config.solver == "auto" && counts.largest_island_rows > config.quick_above_rows;
  counts.quick = config.solver == "quick" || too_large;
  if (too_large) ++quick_steps;
  if (counts.quick) {
    dRandSetSeed(step_seed(seed, step_number));
    dWorldQuickStep(world.get(), step_s);
  } else {
    dWorldStep(world.get(), step_s);
  }
  collider.read_forces(contact_reports);
  dJointGroupEmpty(contacts.get());
  for (Joint* joint : measured_joints) joint->note_load();
}

/// Checks the bodies and lets the joints follow: a group's joints right after its bodies, which are in the
/// cache then.
void PhysicsWorld::Impl::finish(std::int64_t step_number) {
  for (Body* body : kinematic) body->end_kinematic_step();
  auto joint = joints_with_axes.begin();
  const auto update_joints_before = [&](int group) {
    for (; joint != joints_with_axes.end() && joint->first < group; ++joint)
      joint->second->update_position(config.step_s);
  };
  for (const Body* body : moving) {
    update_joints_before(body->group_);
    if (out_of_bounds(*body)) fault(*body, step_number);
  }
  update_joints_before(static_cast<int>(groups.size()));
}

bool PhysicsWorld::Impl::out_of_bounds(const Body& body) const {
  const auto square = [](const dReal* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
  // Written so that NaN is out.  A rotation rate has no bound of its own, but must stay a number.
  return !(square(body.v_WC_W_) <= config.max_speed_mps * config.max_speed_mps &&
           square(body.p_WC_) <= config.max_distance_m * config.max_distance_m && square(body.w_WB_W_) < 1e300);
}

void PhysicsWorld::Impl::fault(const Body& body, std::int64_t step_number) const {
  const double speed = to_eigen(body.v_WC_W_).norm(), distance = to_eigen(body.p_WC_).norm();
  char text[160];
  if (!std::isfinite(distance))
    std::snprintf(text, sizeof text, "position is not finite");
  else if (!std::isfinite(speed))
    std::snprintf(text, sizeof text, "velocity is not finite");
  else if (speed > config.max_speed_mps)
    std::snprintf(text, sizeof text, "speed %.2g m/s is over %g m/s", speed, config.max_speed_mps);
  else if (distance > config.max_distance_m)
    std::snprintf(text, sizeof text, "distance %.3g m from the origin is over %g m", distance, config.max_distance_m);
  else
    std::snprintf(text, sizeof text, "angular velocity is not finite");
  throw PhysicsFault("body '" + body.name() + "': " + text + " at step " + std::to_string(step_number));
}

std::pair<std::string, double> PhysicsWorld::deepest_overlap(int group) const {
  const Collider::Overlap overlap = impl_->collider.deepest_overlap(group);
  return {overlap.group < 0 ? "" : group_name(overlap.group), overlap.depth_m};
}

const Scene& PhysicsWorld::scene() const {
  return *impl_->scene;
}
std::span<const std::unique_ptr<Body>> PhysicsWorld::bodies() const {
  return impl_->bodies;
}
std::span<const std::unique_ptr<Joint>> PhysicsWorld::joints() const {
  return impl_->joints;
}
std::span<const PartInfo> PhysicsWorld::parts() const {
  return impl_->parts;
}
const std::string& PhysicsWorld::group_name(int group) const {
  return impl_->groups.at(static_cast<std::size_t>(group)).name;
}
const StepCounts& PhysicsWorld::last_step() const {
  return impl_->counts;
}
std::int64_t PhysicsWorld::quick_steps() const {
  return impl_->quick_steps;
}
double PhysicsWorld::step_s() const {
  return impl_->config.step_s;
}
std::uint32_t PhysicsWorld::category_bit(const std::string& name) const {
  return impl_->category_bit(name);
}

std::uint32_t PhysicsWorld::Impl::category_bit(const std::string& name) const {
  const auto at = std::find(categories.begin(), categories.end(), name);
  if (at == categories.end()) throw std::out_of_range("unknown category '" + name + "'");
  return 1u << (at - categories.begin());
}

std::uint32_t PhysicsWorld::Impl::category_bits(const std::vector<std::string>& names) const {
  if (names.empty()) return ~0u;
  std::uint32_t bits = 0;
  for (const std::string& name : names) bits |= category_bit(name);
  return bits;
}

void PhysicsWorld::hash_state(StateHash& hash) const {
  constexpr int removed = -1;
  const auto add_all = [&](const auto& all) {
    for (const auto& each : all) each ? each->hash_state(hash) : hash.add(removed);
  };
  add_all(impl_->bodies);
  add_all(impl_->joints);
  if (impl_->gravity_mps2 != impl_->config.gravity_mps2) hash.add(impl_->gravity_mps2);
}

}  // namespace sim
