// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cassert>
#include <utility>

#include "sim/base/linear_algebra.hpp"
#include "sim/config/message_text.hpp"
#include "sim/ode/ode_math.hpp"
#include "sim/physics/physics_world_impl.hpp"

// Addition and removal of groups, their bodies, parts and joints.

namespace sim {

namespace {

std::string part_name(const Body& body, const PartConfig& part, std::size_t index) {
  return body.name() + "/" + (part.name.empty() ? std::to_string(index + 1) : part.name);
}

}  // namespace

int PhysicsWorld::add_group(const std::string& name, bool self_collision) {
  const int number = impl_->group_numbers.take();
  slot(impl_->groups, number) = {name, true, {}, {}, {}, {}, -1, false};
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
  // Create the body.
  std::unique_ptr<Body> owned(new Body);
  Body& body = *owned;
  body.name_ = owner.name + "/" + config.name;
  body.number_ = impl_->body_numbers.next();  // taken only on success
  body.group_ = group;
  body.motion_ = motion;
  body.moves_ = &impl_->moves;
  if (motion != Motion::fixed) {
    if (owner.shard < 0) {
      owner.shard = group;
      impl_->shard(group).groups = {group};
    }
    impl_->attach_ode_body(body, impl_->shards[owner.shard]->world.get());
  }
  // Add parts and mass, and register with collider and islands.
  impl_->add_parts(body, config);
  impl_->collider.add_body(body.number_, impl_->collision_body(body));
  impl_->islands.add_body(body.number_);
  if (motion != Motion::fixed) {
    owner.moving.push_back(&body);
    impl_->shards[owner.shard]->stale = true;
    impl_->shards_listed = false;
  }
  const bool noted = impl_->collider.has_noted_positions(impl_->moves);
  body.set_pose(X_WV * make_pose(config.position_m, config.rpy_rad));
  if (noted) impl_->collider.note_positions(impl_->moves);  // close_group() notes that of this body
  owner.bodies.push_back(impl_->body_numbers.take());
  slot(impl_->bodies, body.number_) = std::move(owned);
  return body;
}

CollisionBody PhysicsWorld::Impl::collision_body(const Body& body) const {
  return {body.free(),  body.ode_.get(), body.p_WC_,
          body.v_WC_W_, body.w_WB_W_,    body.mass_kg_ > 0 ? 1 / body.mass_kg_ : 0};
}

void PhysicsWorld::Impl::attach_ode_body(Body& body, dWorldID world) {
  const dBodyID ode = dBodyCreate(world);
  dBodySetData(ode, &body);
  body.ode_.reset(ode);
  const auto writable = [](const dReal* of_ode) { return const_cast<dReal*>(of_ode); };
  body.p_WC_ = writable(dBodyGetPosition(ode));
  body.q_WB_ = writable(dBodyGetQuaternion(ode));
  body.R_WB_ = writable(dBodyGetRotation(ode));
  body.v_WC_W_ = writable(dBodyGetLinearVel(ode));
  body.w_WB_W_ = writable(dBodyGetAngularVel(ode));
  body.force_N_ = writable(dBodyGetForce(ode));
  body.torque_Nm_ = writable(dBodyGetTorque(ode));
  // Replaced by Body::add_gyroscopic_torque.
  dBodySetGyroscopicMode(ode, 0);
  if (!body.kinematic()) return;
  body.gyroscopic_ = false;
  dBodySetKinematic(ode);
  dBodySetGravityMode(ode, 0);
  // Makes a step rotate the body by exactly its angular velocity.
  dBodySetFiniteRotationMode(ode, 1);
}

void PhysicsWorld::Impl::add_parts(Body& body, const BodyConfig& config_) {
  // All parts are checked and created before any is added, so that an exception leaves no incomplete body.
  std::vector<NewPart> made;
  dMass total;
  dMassSetZero(&total);
  for (std::size_t i = 0; i < config_.parts.size(); ++i) {
    const PartConfig& part = config_.parts[i];
    const std::string who =
        "body '" + body.name() + "': part " + (part.name.empty() ? std::to_string(i + 1) : "'" + part.name + "'");
    made.push_back(make_part(body, part, who));
    if (!body.free()) continue;
    const dMass mass = part_mass(part, made.back().mesh, who);
    if (mass.mass > 0) dMassAdd(&total, &mass);
  }
  if (body.free()) set_mass(body, config_, total);
  for (std::size_t i = 0; i < made.size(); ++i) add_part(body, config_, i, std::move(made[i]));
}

PhysicsWorld::Impl::NewPart PhysicsWorld::Impl::make_part(const Body& body, const PartConfig& part,
                                                          const std::string& who) {
  if (!shape_info(part.shape).solid && !body.fixed())
    throw_config_error(part.place, who,
                       "a " + std::string(word_of(part_shape_words, part.shape)) + " can only be part of a fixed body");
  NewPart made;
  if (part.shape == PartShape::terrain) {
    made.terrain = std::make_unique<CollisionTerrain>(part, who, collider.table(), meshes);
    made.geom = make_terrain_geom(*made.terrain);
  } else {
    made.mesh = part.shape == PartShape::mesh ? &meshes.get(part, who) : nullptr;
    made.geom = make_geom(part, made.mesh);
  }
  return made;
}

void PhysicsWorld::Impl::add_part(Body& body, const BodyConfig& config_, std::size_t index, NewPart made) {
  const PartConfig& part = config_.parts[index];
  const dGeomID geom = made.geom.get();
  // Place the geom on the body.
  const Pose X_BG = make_pose(part.position_m, part.rpy_rad);
  if (body.fixed()) {
    body.fixed_geoms_.push_back({geom, X_BG, part.shape == PartShape::plane});
  } else {
    // A zero offset would still cost a matrix product in each step.
    const Vector3d p_CG = X_BG.translation() - body.p_BC_;
    dGeomSetBody(geom, body.ode_.get());
    if (!p_CG.isZero(0)) dGeomSetOffsetPosition(geom, p_CG.x(), p_CG.y(), p_CG.z());
    dQuaternion q;
    to_ode(to_quaternion(X_BG.linear()), q);
    if (!part.rpy_rad.isZero(0)) dGeomSetOffsetQuaternion(geom, q);
  }
  // Number and describe the part.
  const CollisionPart collision{geom,
                                body.number_,
                                body.group_,
                                collider.table().number_of(part.material),
                                category_bit(part.category),
                                category_bits(part.collides_with),
                                made.terrain.get()};
  const int number = part_numbers.take();
  groups[body.group_].parts.push_back(number);
  slot(shard_of_part, number) = body.fixed() ? -1 : groups[body.group_].shard;
  slot(parts, number) = {part_name(body, part, index),
                         body.group_,
                         body.number_,
                         collision.material,
                         collision.category,
                         X_BG,
                         parse_color(part.color),
                         part.shape == PartShape::plane};
  // Add the part to the scene and the collider.
  scene->add_part(number,
                  {geom, body.group_, collision.category, collision.material,
                   collider.table().material(collision.material).transmits(), !body.fixed(),
                   made.mesh      ? &made.mesh->mesh
                   : made.terrain ? &made.terrain->mesh
                                  : nullptr,
                   made.terrain ? std::span<const int>(made.terrain->triangle_materials) : std::span<const int>{}});
  collider.add_part(number, collision, std::move(made.geom), body.motion_);
  if (made.terrain) terrains[number] = std::move(made.terrain);
}

namespace {

/// Mass, center of mass and inertia given in a body's hydrodynamics, in body axes.
dMass published_mass(const HydrodynamicsConfig& config) {
  const auto flip = [](int i) { return i == 0 ? 1.0 : -1.0; };  // forward-right-down to forward-left-up
  dMass mass;
  dMassSetZero(&mass);
  mass.mass = config.mass_kg;
  const Vector3d& c = config.center_of_mass_m;
  const Matrix3d about_origin =
      config.inertia_kgm2 + config.mass_kg * (c.squaredNorm() * Matrix3d::Identity() - c * c.transpose());
  for (int i = 0; i < 3; ++i) {
    mass.c[i] = flip(i) * c[i];
    for (int j = 0; j < 3; ++j) mass.I[4 * i + j] = flip(i) * flip(j) * about_origin(i, j);
  }
  return mass;
}

}  // namespace

void PhysicsWorld::Impl::set_mass(Body& body, const BodyConfig& config_, const dMass& of_parts) {
  // Use the given mass, or the sum of the parts.
  const bool published = config_.hydrodynamics && config_.hydrodynamics->mass_kg > 0;
  const dMass total = published ? published_mass(*config_.hydrodynamics) : of_parts;
  if (!(total.mass > 0)) {
    const SourcePlace place = config_.parts.empty() ? config_.place : config_.parts.front().place;
    throw_config_error(place, "body '" + body.name() + "'", "has no mass: give a part mass_kg or density_kgpm3");
  }
  // Move the inertia to the center of mass.
  dMass mass = total;
  body.mass_kg_ = mass.mass;
  body.p_BC_ = to_eigen(mass.c);
  dMassTranslate(&mass, -mass.c[0], -mass.c[1], -mass.c[2]);
  mass.c[0] = mass.c[1] = mass.c[2] = 0;  // exactly, or ODE aborts
  body.inertia_C_B_ = rotation_to_eigen(mass.I);
  // With equal moments, as of spheres and cubes, the gyroscopic torque is zero.
  const double mean = body.inertia_C_B_.trace() / 3;
  body.gyroscopic_ = !body.inertia_C_B_.isApprox(mean * Matrix3d::Identity(), 1e-12);
  // Check the range in which ODE can invert the inertia; ODE's own error would not name the body.
  const Vector3d moments = symmetric_eigenvalues(body.inertia_C_B_);
  const bool solvable = mass.mass < 1e30 && moments.minCoeff() > 1e-60 && moments.maxCoeff() < 1e60;
  if (!solvable)
    throw_config_error(
        config_.parts.empty() ? config_.place : config_.parts.front().place, "body '" + body.name() + "'",
        "its moments of inertia must be above 1e-60 and below 1e60 kg m2, got " + number_text(moments.minCoeff()) +
            " to " + number_text(moments.maxCoeff()) + " with " + number_text(mass.mass) + " kg");
  dBodySetMass(body.ode_.get(), &mass);
}

Joint& PhysicsWorld::add_joint(int group, const JointConfig& config, Body& first, Body* second, const Pose& X_WV) {
  Impl::Group& owner = impl_->group(group);
  assert(first.group_ == group && (!second || second->group_ == group));  // else a removal leaves a dangling joint
  const std::string name = owner.name + "/" + config.name;
  const dBodyID a = first.ode_.get(), b = second ? second->ode_.get() : nullptr;
  // Check that ODE can make this joint.
  if (!first.free() && !(second && second->free()))
    throw_config_error({}, "joint '" + name + "'", "joins two bodies that are fixed or kinematic");
  if (config.type == JointType::hinge2 && (!a || !b))
    throw_config_error({}, "joint '" + name + "'", "hinge2 needs two bodies that move");
  if (second == &first) throw_config_error({}, "joint '" + name + "'", "joins a body to itself");
  std::unique_ptr<Joint> owned(new Joint(dBodyGetWorld(a ? a : b), name, config, a, b, X_WV));
  Joint& joint = *owned;
  // Without finite rotation a wheel turns too little in each step: 7 % at 100 rad/s and 10 ms.
  if (joint_info(config.type).carries_a_wheel) {
    dBodySetFiniteRotationMode(b ? b : a, 1);
    impl_->find_wheels(config, first, second, X_WV);
  }
  owner.anchored |= joint.origin_->to_world;
  impl_->shards[owner.shard]->stale = true;
  impl_->shards_listed = false;
  // Register the joint with islands and collider.
  impl_->islands.add_joint(a ? first.number_ : -1, b ? second->number_ : -1, joint.max_rows());
  if (second) impl_->collider.join(first.number_, second->number_);
  owner.joints.push_back(impl_->joint_numbers.take());
  slot(impl_->joints, owner.joints.back()) = std::move(owned);
  return joint;
}

/// Finds the wheels among the parts of the bodies of a hinge or hinge2.
void PhysicsWorld::Impl::find_wheels(const JointConfig& hinge, const Body& first, const Body* second,
                                     const Pose& X_WV) {
  std::vector<int> own;
  for (const int part : groups[first.group_].parts)
    if (parts[part].body == first.number_ || (second && parts[part].body == second->number_)) own.push_back(part);
  const Vector3d& axis_V = (hinge.type == JointType::hinge2 ? hinge.axis2 : hinge.axis1).axis;
  collider.find_wheels(own, X_WV * hinge.anchor_m, X_WV.linear() * axis_V);
}

void PhysicsWorld::close_group(int group) {
  const Impl::Group& closed = impl_->group(group);
  double mass_kg = 0;
  for (const int body : closed.bodies) mass_kg += impl_->bodies[body]->mass_kg();
  impl_->collider.load_wheels(closed.parts, mass_kg);
  impl_->collider.close_group(group);
  impl_->plan_leaps(impl_->group(group));
  impl_->note_group(group);
  impl_->scene->close_group(group);
}

void PhysicsWorld::remove_group(int group) {
  Impl& all = *impl_;
  Impl::Group& removed = all.group(group);
  std::erase_if(all.contact_reports, [&](const ContactReport& contact) {
    return all.parts[contact.parts[0]].group == group || all.parts[contact.parts[1]].group == group;
  });
  all.note_group(group);
  all.far_groups.remove(group);
  const int shard = removed.shard;
  all.leave_shard(group);
  all.scene->remove_group(group, removed.parts);
  for (const int joint : removed.joints) all.joints[joint].reset();
  all.collider.remove_group(group, removed.bodies, removed.parts);
  all.islands.remove_bodies(removed.bodies);
  for (const int body : removed.bodies) all.bodies[body].reset();
  if (shard >= 0 && all.shards[shard]->groups.empty()) all.shards[shard].reset();
  for (const int part : removed.parts) {
    all.terrains.erase(part);
    all.parts[part] = {};
  }
  for (const int number : removed.joints) all.joint_numbers.give_back(number);
  for (const int number : removed.bodies) all.body_numbers.give_back(number);
  for (const int number : removed.parts) all.part_numbers.give_back(number);
  removed = {};
  all.shards_listed = false;
  all.group_numbers.give_back(group);
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

GroupNumbers PhysicsWorld::numbers_of(int group) const {
  const Impl::Group& owner = impl_->group(group);
  return {group, owner.bodies, owner.parts, owner.joints};
}

void PhysicsWorld::prescribe(const GroupNumbers& numbers) {
  impl_->group_numbers.prescribe({numbers.group});
  impl_->body_numbers.prescribe(numbers.bodies);
  impl_->part_numbers.prescribe(numbers.parts);
  impl_->joint_numbers.prescribe(numbers.joints);
}

bool PhysicsWorld::as_prescribed() const {
  const Impl& all = *impl_;
  return all.group_numbers.as_prescribed() && all.body_numbers.as_prescribed() && all.part_numbers.as_prescribed() &&
         all.joint_numbers.as_prescribed();
}

std::vector<JointPlace> PhysicsWorld::joint_places(int group) const {
  std::vector<JointPlace> places;
  for (const int number : impl_->group(group).joints)
    if (const auto& made = *impl_->joints[number]->origin_; made.to_world) places.push_back({made.X_WV, made.X_WC});
  return places;
}

void PhysicsWorld::make_joints_again(int group, std::span<const JointPlace> places) {
  if (places.size() != joint_places(group).size()) throw std::out_of_range("other joints to the world");
  auto place = places.begin();
  for (const int number : impl_->group(group).joints) {
    Joint& joint = *impl_->joints[number];
    if (!joint.origin_->to_world) continue;
    joint.make_again(place->X_WV, place->X_WC);
    ++place;
  }
}

}  // namespace sim
