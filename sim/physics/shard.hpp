// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <vector>

#include "sim/collision/collider.hpp"
#include "sim/ode/body_copy.hpp"
#include "sim/ode/calls_at_once.hpp"
#include "sim/ode/ode_library.hpp"
#include "sim/physics/body.hpp"
#include "sim/physics/crowd_contacts.hpp"
#include "sim/physics/joint.hpp"

namespace sim {

/// ODE world with the groups that are near each other: usually one vehicle.  Shards are stepped in any order, and by
/// any thread; where a group is does not change any bit of its motion, because
/// - the groups of a shard are created in the order of their numbers, in which ODE walks through its bodies,
/// - the contacts of a shard are made in the order of the parts,
/// - the solver treats each island for itself (see ode_random.cpp, and Impl::step_exactly).
struct Shard {
  WorldHandle world;
  std::vector<int> groups;  ///< ascending
  // Of the groups, in their order; listed again when `stale`.
  std::vector<Body*> moving;  ///< free and kinematic
  std::vector<Joint*> joints;
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

/// Scratch data of a thread that steps shards; it carries no state from one shard to the next.
struct ShardStepper {
  explicit ShardStepper(const PhysicsConfig& config)
      : making(config.max_contacts_per_pair),
        crowd_contacts({config.step_s, config.erp, config.cfm, config.contact_surface_layer_m,
                        config.contact_max_correcting_velocity_mps}) {}
  SolverMemory memory;
  Collider::Making making;
  std::vector<Body*> lone;                   ///< bodies without contacts and joints in this step
  std::vector<Joint*> leaving;               ///< joints whose motors leave a stop in this step
  std::vector<BodyCopy> before;              ///< of the bodies that the exact solver steps
  std::vector<dBodyID> small, crowd, mixed;  ///< bodies by their islands
  CrowdContacts crowd_contacts;
};

}  // namespace sim
