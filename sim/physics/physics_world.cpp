#include "sim/physics/physics_world.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sim/physics/collider.hpp"
#include "sim/physics/islands.hpp"
#include "sim/physics/ode_library.hpp"
#include "sim/physics/ode_math.hpp"
#include "sim/physics/part_shape.hpp"
#include "sim/scene/ode_scene.hpp"

namespace sim {

// Members are destroyed from the last to the first: joints and bodies before their world.
struct PhysicsWorld::Impl {
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
  std::vector<std::string> groups;
  std::vector<PartInfo> parts;
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<Body*> moving;
  std::vector<std::unique_ptr<Joint>> joints;
  std::vector<std::pair<int, Joint*>> joints_with_axes;  // with their groups
  SceneMoves moves;
  std::unique_ptr<OdeScene> scene;
  StepCounts counts;
  std::int64_t quick_steps = 0;
  bool broken = false;  ///< ODE threw in mid-step

  std::uint32_t category_bit(const std::string& name) const;
  std::uint32_t category_bits(const std::vector<std::string>& names) const;
  void add_parts(Body& body, const BodyConfig& config, bool fixed);
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
  impl_->groups.push_back(name);
  impl_->scene->add_group();
  return impl_->collider.add_group(self_collision);
}

Body& PhysicsWorld::add_body(int group, const BodyConfig& config, const Pose& X_WV, bool fixed) {
  std::unique_ptr<Body> owned(new Body);
  Body& body = *owned;
  body.name_ = impl_->groups[group] + "/" + config.name;
  body.number_ = static_cast<int>(impl_->bodies.size());
  body.group_ = group;
  body.moves_ = &impl_->moves;
  const Pose X_WB = X_WV * make_pose(config.position_m, config.rpy_rad);
  body.fixed_X_WB_ = X_WB;
  if (!fixed) {
    body.ode_.reset(dBodyCreate(impl_->world.get()));
    body.p_WC_ = dBodyGetPosition(body.ode_.get());
    body.R_WB_ = dBodyGetRotation(body.ode_.get());
    body.v_WC_W_ = dBodyGetLinearVel(body.ode_.get());
    body.w_WB_W_ = dBodyGetAngularVel(body.ode_.get());
    // Our own gyroscopic torque, see Body::add_gyroscopic_torque.
    dBodySetGyroscopicMode(body.ode_.get(), 0);
  }
  impl_->add_parts(body, config, fixed);
  impl_->collider.add_body(
      {body.ode_.get(), body.p_WC_, body.v_WC_W_, body.w_WB_W_, body.mass_kg_ > 0 ? 1 / body.mass_kg_ : 0});
  impl_->islands.add_body();
  if (!fixed) impl_->moving.push_back(&body);
  body.set_pose(X_WB);
  impl_->bodies.push_back(std::move(owned));
  return body;
}

void PhysicsWorld::Impl::add_parts(Body& body, const BodyConfig& config_, bool fixed) {
  // Checked and made first, added after: an exception leaves no half body behind.
  std::vector<GeomHandle> geoms;
  dMass total;
  dMassSetZero(&total);
  for (std::size_t i = 0; i < config_.parts.size(); ++i) {
    const PartConfig& part = config_.parts[i];
    const std::string who =
        "body '" + body.name() + "': part " + (part.name.empty() ? std::to_string(i + 1) : "'" + part.name + "'");
    if (part.shape == "plane" && !fixed)
      throw_config_error(part.place, who, "a plane can only be part of a fixed body");
    const CollisionMesh* mesh = part.shape == "mesh" ? &meshes.get(part, who) : nullptr;
    geoms.push_back(make_geom(part, mesh));
    if (fixed) continue;
    const dMass mass = part_mass(part, mesh, who);
    if (mass.mass > 0) dMassAdd(&total, &mass);
  }
  if (!fixed) set_mass(body, config_, total);
  for (std::size_t i = 0; i < geoms.size(); ++i) {
    const PartConfig& part = config_.parts[i];
    const dGeomID geom = geoms[i].get();
    const Pose X_BG = make_pose(part.position_m, part.rpy_rad);
    if (fixed) {
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
    parts.push_back({part_name(body, part, i), body.group_, body.number_, collision.material, collision.category});
    scene->add_part(geom, body.group_, collision.category, !fixed);
    collider.add_part(collision, std::move(geoms[i]), !fixed);
  }
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
  const std::string name = impl_->groups[group] + "/" + config.name;
  const dBodyID a = first.ode_.get(), b = second ? second->ode_.get() : nullptr;
  if (!a && !b) throw_config_error({}, "joint '" + name + "'", "joins two fixed bodies");
  if (config.type == "hinge2" && (!a || !b))
    throw_config_error({}, "joint '" + name + "'", "hinge2 needs two bodies that move");
  if (second == &first) throw_config_error({}, "joint '" + name + "'", "joins a body to itself");
  std::unique_ptr<Joint> owned(new Joint(impl_->world.get(), name, config, a, b, X_WV));
  Joint& joint = *owned;
  // Without it a wheel turns too little in each step: 7 % at 100 rad/s and 10 ms.
  if (config.type == "hinge" || config.type == "hinge2") dBodySetFiniteRotationMode(b ? b : a, 1);
  impl_->islands.add_joint(a ? first.number_ : -1, b ? second->number_ : -1, joint.max_rows());
  if (second) impl_->collider.join(first.number_, second->number_);
  if (joint.axes() > 0) impl_->joints_with_axes.emplace_back(group, &joint);
  impl_->joints.push_back(std::move(owned));
  return joint;
}

void PhysicsWorld::close_group(int group) {
  impl_->collider.close_group(group);
  impl_->scene->close_group(group);
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
  islands.begin_step();
  counts.contacts = collider.collide(world.get(), contacts.get(), islands);
  counts.largest_island_rows = islands.largest_rows();
}

void PhysicsWorld::Impl::solve(std::int64_t step_number) {
  const double step_s = config.step_s;
  for (Body* body : moving)
    if (body->gyroscopic_) body->add_gyroscopic_torque(step_s);
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
  dJointGroupEmpty(contacts.get());
}

/// Checks the bodies and lets the joints follow: a group's joints right after its bodies, which are in the
/// cache then.
void PhysicsWorld::Impl::finish(std::int64_t step_number) {
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
  return impl_->groups.at(group);
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
  for (const auto& body : impl_->bodies) body->hash_state(hash);
  for (const auto& joint : impl_->joints) joint->hash_state(hash);
}

}  // namespace sim
