// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "sim/base/thread_pool.hpp"
#include "sim/collision/collider.hpp"
#include "sim/collision/islands.hpp"
#include "sim/physics/far_groups.hpp"
#include "sim/physics/groups.hpp"
#include "sim/physics/leaps.hpp"
#include "sim/physics/moved_bodies.hpp"
#include "sim/physics/parts.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/physics/shards.hpp"
#include "sim/physics/single_bodies.hpp"
#include "sim/physics/step_report.hpp"
#include "sim/rays/world_scene.hpp"

namespace sim {

/// The objects of a PhysicsWorld; each header begins with what it owns.
///
///     Parts          what parts are, meshes, terrains        Groups        bodies, joints, their numbers
///     Collider       what touches; contact joints            Islands       rows of what is connected
///     FarGroups      what cannot touch anything soon         SingleBodies  the step without ODE
///     Shards         ODE worlds, and their step              Leaps         bodies that are too fast
///     MovedBodies    what is looked at when one was moved    StepReport    contacts and counts of a step
///
/// Order within step(): FarGroups takes groups out of the collision space or brings them back; Collider finds the
/// pairs; Shards brings groups with pairs together and deals the pairs; SingleBodies steps what has none; Shards steps
/// the rest; StepReport collects; a body out of bounds or an error of ODE is thrown; Leaps looks at what was fast.
///
/// PhysicsWorld tells each of them of added and removed groups.  Threads share only the two steps.  The state of a
/// world is in its bodies and joints, which World visits, in the gravity and the report; all else follows from them.
struct PhysicsWorld::Impl {
  Impl(const PhysicsConfig& config, ContactTable table, std::uint64_t seed);
  void step(std::int64_t step_number);
  void use_gravity(double gravity_mps2);

  // Members are destroyed from the last to the first: joints and bodies before their ODE worlds, the geoms of collider
  // and scene before the meshes that they point into.
  StepSettings settings;
  bool gravity_was_set = false;  ///< set_gravity() was called
  SceneMoves moves;
  Parts parts;
  Shards shards;
  Collider collider;
  Islands islands;
  Groups groups;
  FarGroups far_groups;
  Leaps leaps;
  MovedBodies moved;
  SingleBodies singles;
  StepReport report;
  std::unique_ptr<WorldScene> scene;
  std::unique_ptr<ThreadPool> threads;  ///< null: one thread
};

}  // namespace sim
