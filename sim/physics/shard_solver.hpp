// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include "sim/collision/collider.hpp"
#include "sim/collision/crowd_contacts.hpp"
#include "sim/collision/islands.hpp"
#include "sim/ode/body_copy.hpp"
#include "sim/ode/calls_at_once.hpp"
#include "sim/physics/groups.hpp"
#include "sim/physics/moved_bodies.hpp"

namespace sim {

/// ODE world with the groups that are near each other: usually one vehicle.  Shards are stepped in any order, and by
/// any thread; where a group is does not change any bit of its motion, because
/// - the groups of a shard are created in the order of their numbers, in which ODE walks through its bodies,
/// - the contacts of a shard are made in the order of the parts,
/// - the solver treats each island for itself (see ode_random.cpp, and ShardSolver::step_exactly).
struct Shard {
  WorldHandle world;
  std::vector<int> groups;  ///< ascending
  // Of the groups, in their order; listed again when `stale`.
  std::vector<SteppedBody*> moving;  ///< free and kinematic
  std::vector<SteppedJoint*> joints;
  bool stale = true;

  // Of the last step.
  std::vector<Collider::Pair> pairs;
  std::vector<ContactReport> contacts;  ///< of watched groups
  int contact_count = 0;
  int max_rows = 0;
  bool quick = false;          ///< some island was stepped as a crowd or by QuickStep
  bool quick_instead = false;  ///< although the solver is not `quick`
  bool solver_failed = false;
  bool out_of_bounds = false;  ///< some body is
  std::exception_ptr fault;
};

/// What all steps of a world have in common.
struct StepSettings {
  PhysicsConfig config;
  std::uint64_t seed;
  double gravity_mps2 = config.gravity_mps2;  ///< positive downwards; from the next step on
};

/// Makes the step of a shard; each thread has its own.  This class owns only buffers, which carry nothing from one
/// shard to the next: the working memory of ODE's solver, and the contacts and lists of bodies of the present step.
///
/// Order within step():
/// 1. kinematic bodies start, planned velocities become forces where there are contacts,
/// 2. Collider makes the contact joints of the shard's pairs, and Islands counts their rows,
/// 3. bodies with neither joints nor contacts are stepped alone; if that is all, ODE is not called,
/// 4. dampers, and stops that motors leave, become joints; what a load is measured from is noted,
/// 5. the solver: dWorldStep, which is exact, and whose cost grows with the cube of the rows of an island; or, for
/// large
///    islands, QuickStep, or CrowdContacts and then dWorldStep.  The choice depends on rows only, never on a clock,
/// 6. forces of contacts and loads of joints are read, and the joints of the step destroyed,
/// 7. kinematic bodies reach their poses; MovedBodies looks at all; joints update their positions.
/// An error of ODE is kept in the shard, and thrown when the other shards are done.
///
/// Several threads may step different shards.  They share Islands, but no island lies in two shards.
class ShardSolver {
 public:
  ShardSolver(const StepSettings& settings, const Groups& groups, const Collider& collider, Islands& islands,
              const MovedBodies& moved);
  void step(Shard& shard, std::int64_t step_number);

 private:
  void begin(Shard& shard);
  void solve(Shard& shard, std::int64_t step_number);
  void end(Shard& shard) const;
  bool step_lone_bodies(const Shard& shard);
  void start_joints(const Shard& shard);
  void call_solver(Shard& shard, std::int64_t step_number);
  void quick_step(dWorldID world, std::int64_t step_number) const;
  void step_exactly(Shard& shard, std::int64_t step_number);
  void step_islands_by_size(Shard& shard, std::int64_t step_number);
  void sort_by_islands(const Shard& shard);
  void push_crowds();
  template <class IslandOf>
  void step_or_fall_back(Shard& shard, std::int64_t step_number, const IslandOf& island_of);
  bool is_large(const SteppedBody& body) const;
  bool is_mixed(const SteppedBody& body) const;
  std::string suspects(const Shard& shard) const;

  const StepSettings& settings_;
  const PhysicsConfig& config_;
  const Groups& groups_;
  const Collider& collider_;
  Islands& islands_;
  const MovedBodies& moved_;
  SolverMemory memory_;
  Collider::Making making_;
  std::vector<SteppedBody*> lone_;              // without contacts and joints in this step
  std::vector<SteppedJoint*> leaving_;          // whose motors leave a stop in this step
  std::vector<BodyCopy> before_;                // of the bodies that the exact solver steps
  std::vector<dBodyID> small_, crowd_, mixed_;  // bodies by their islands
  std::vector<int> mixed_islands_;              // sorted
  CrowdContacts crowd_contacts_;
};

}  // namespace sim
