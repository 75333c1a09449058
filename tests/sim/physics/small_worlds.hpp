// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/physics/physics_world.hpp"
#include "tests/sim/physics/gravity.hpp"

/// Worlds in a few lines, for the tests and measurements of physics and scene.
namespace small_worlds {

using sim::BodyConfig;
using sim::ContactConfig;
using sim::JointConfig;
using sim::JointType;
using sim::MaterialConfig;
using sim::Motion;
using sim::PartConfig;
using sim::PartShape;
using sim::PhysicsConfig;
using sim::PhysicsWorld;
using sim::Pose;
using sim::Vector3d;

inline PartConfig box(const Vector3d& size_m, double mass_kg) {
  PartConfig part;
  part.shape = PartShape::box;
  part.size_m = size_m;
  if (mass_kg > 0) part.mass_kg = mass_kg;
  return part;
}

inline PartConfig sphere(double radius_m, double mass_kg) {
  PartConfig part;
  part.shape = PartShape::sphere;
  part.radius_m = radius_m;
  if (mass_kg > 0) part.mass_kg = mass_kg;
  return part;
}

/// Capsule or cylinder along z.
inline PartConfig round(PartShape shape, double radius_m, double length_m, double mass_kg) {
  PartConfig part = sphere(radius_m, mass_kg);
  part.shape = shape;
  part.length_m = length_m;
  return part;
}

inline PartConfig plane() {
  PartConfig part;
  part.shape = PartShape::plane;
  return part;
}

inline PartConfig at(PartConfig part, const Vector3d& position_m, const Vector3d& rpy_rad = Vector3d::Zero()) {
  part.position_m = position_m;
  part.rpy_rad = rpy_rad;
  return part;
}

inline BodyConfig body(const std::string& name, std::vector<PartConfig> parts,
                       const Vector3d& position_m = Vector3d::Zero()) {
  BodyConfig config;
  config.name = name;
  config.parts = std::move(parts);
  config.position_m = position_m;
  return config;
}

inline JointConfig joint(const std::string& name, JointType type, const Vector3d& anchor_m,
                         const Vector3d& axis = Vector3d::UnitZ()) {
  JointConfig config;
  config.name = name;
  config.type = type;
  config.anchor_m = anchor_m;
  config.axis1.axis = axis;
  return config;
}

inline Pose translation(double x, double y, double z) {
  return sim::make_pose({x, y, z}, Vector3d::Zero());
}

/// A group of one body.
inline sim::Body& add(PhysicsWorld& world, const BodyConfig& config, const Pose& X_W, Motion motion = Motion::free) {
  const int group = world.add_group(config.name);
  sim::Body& added = world.add_body(group, config, X_W, motion);
  world.close_group(group);
  return added;
}

inline sim::Body& add_ground(PhysicsWorld& world, const Pose& X_W = Pose::Identity()) {
  return add(world, body("ground", {plane()}), X_W, Motion::fixed);
}

inline std::unique_ptr<PhysicsWorld> make_world(const PhysicsConfig& config = {},
                                                const std::vector<ContactConfig>& contacts = {}) {
  return std::make_unique<PhysicsWorld>(config, std::vector<MaterialConfig>{{"slippery"}}, contacts,
                                        std::vector<std::string>{}, 1);
}

inline PhysicsConfig with_step(double step_s, double gravity_mps2 = test::g) {
  PhysicsConfig config;
  config.step_s = step_s;
  config.gravity_mps2 = gravity_mps2;
  return config;
}

inline PhysicsConfig weightless(double step_s = 0.01) {
  return with_step(step_s, 0);
}

/// A group whose body `base` is heavy and whose body `arm` is light, both cubes, the arm 1 m along x.
struct CubePair {
  explicit CubePair(const JointConfig& config, bool to_world = false, const PhysicsConfig& physics = weightless())
      : world(make_world(physics)) {
    const int group = world->add_group("rig");
    base = &world->add_body(group, body("base", {box({0.2, 0.2, 0.2}, 1000)}), Pose::Identity(),
                            to_world ? Motion::fixed : Motion::free);
    arm = &world->add_body(group, body("arm", {box({0.2, 0.2, 0.2}, 1)}, {1, 0, 0}), Pose::Identity());
    joint = &world->add_joint(group, config, *base, arm, Pose::Identity());
    world->close_group(group);
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) world->step(step++);
  }
  std::unique_ptr<PhysicsWorld> world;
  sim::Body* base;
  sim::Body* arm;
  sim::Joint* joint;
  int step = 0;
};

inline void run_for(PhysicsWorld& world, double time_s) {
  const auto steps = std::lround(time_s / world.step_s());
  for (int i = 0; i < steps; ++i) world.step(i);
}

/// Contacts with `slippery` have no friction.
inline ContactConfig slippery() {
  ContactConfig contact;
  contact.between = {"any", "slippery"};
  contact.friction = 0;
  return contact;
}

/// A robot with two driven wheels and a caster that slides; drives along +x.  Its wheels stand on z = 0, its
/// weight is behind the axle, so that it stands on the caster.
struct Rover {
  static constexpr double wheel_radius_m = 0.1;
  static constexpr double half_track_m = 0.2;

  sim::Body* chassis;
  sim::Joint* left;
  sim::Joint* right;
};

inline Rover add_rover(PhysicsWorld& world, const std::string& name, const Pose& X_WV,
                       const PartConfig& wheel = sphere(Rover::wheel_radius_m, 0.5)) {
  const Vector3d axle = {0, Rover::half_track_m, Rover::wheel_radius_m};
  const Vector3d mirrored = {axle.x(), -axle.y(), axle.z()};
  PartConfig caster = at(sphere(0.05, 0), {-0.2, 0, -0.1});
  caster.material = "slippery";
  const int group = world.add_group(name);
  sim::Body& chassis =
      world.add_body(group, body("chassis", {at(box({0.5, 0.3, 0.1}, 5), {-0.05, 0, 0}), caster}, {0, 0, 0.15}), X_WV);
  sim::Body& left_wheel = world.add_body(group, body("left_wheel", {wheel}, axle), X_WV);
  sim::Body& right_wheel = world.add_body(group, body("right_wheel", {wheel}, mirrored), X_WV);
  Rover rover{&chassis, nullptr, nullptr};
  rover.left =
      &world.add_joint(group, joint("left", JointType::hinge, axle, Vector3d::UnitY()), chassis, &left_wheel, X_WV);
  rover.right = &world.add_joint(group, joint("right", JointType::hinge, mirrored, Vector3d::UnitY()), chassis,
                                 &right_wheel, X_WV);
  world.close_group(group);
  return rover;
}

}  // namespace small_worlds
