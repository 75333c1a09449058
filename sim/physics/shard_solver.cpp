// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/shard_solver.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "sim/config/message_text.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

namespace {

/// Seed of QuickStep's shuffle; depends only on the world's seed and the step.
unsigned long step_seed(std::uint64_t seed, std::int64_t step_number) {
  StateHash hash;
  hash.add(seed);
  hash.add(step_number);
  return static_cast<unsigned long>(hash.value() >> 32);
}

const SteppedBody& body_of(dBodyID ode) {
  return *static_cast<const SteppedBody*>(dBodyGetData(ode));
}

/// Steps the enabled bodies without some others.
template <class Step>
void step_all_but(const std::vector<dBodyID>& others, const Step& step) {
  for (const dBodyID body : others) dBodyDisable(body);
  step();
  for (const dBodyID body : others) dBodyEnable(body);
}

}  // namespace

ShardSolver::ShardSolver(const StepSettings& settings, const Groups& groups, const Collider& collider, Islands& islands,
                         const MovedBodies& moved)
    : settings_(settings),
      config_(settings.config),
      groups_(groups),
      collider_(collider),
      islands_(islands),
      moved_(moved),
      making_(config_.max_contacts_per_pair),
      crowd_contacts_({config_.step_s, config_.erp, config_.cfm, config_.contact_surface_layer_m,
                       config_.contact_max_correcting_velocity_mps}) {}

void ShardSolver::step(Shard& shard, std::int64_t step_number) {
  shard.fault = nullptr;
  shard.solver_failed = shard.out_of_bounds = false;
  try {
    begin(shard);
    solve(shard, step_number);
  } catch (const PhysicsFault& error) {
    shard.solver_failed = true;
    shard.fault = std::make_exception_ptr(PhysicsFault(suspects(shard) + "the solver failed at step " +
                                                       std::to_string(step_number) + " (" + error.what() + ")"));
  }
  end(shard);
}

void ShardSolver::begin(Shard& shard) {
  for (SteppedBody* body : shard.moving)
    if (body->kinematic()) body->start_kinematic_step();
  if (!shard.pairs.empty())
    for (SteppedBody* body : shard.moving)
      if (body->planned()) body->apply_plan();
  std::sort(shard.pairs.begin(), shard.pairs.end());
  collider_.make_contacts(shard.pairs, shard.world.get(), islands_, making_);
  shard.contact_count = making_.count;
  shard.max_rows = making_.max_rows;
}

/// Kinematic bodies reach their poses, and joints their positions.
void ShardSolver::end(Shard& shard) const {
  MovedBodies::Batch batch;
  for (SteppedBody* body : shard.moving) {
    if (body->kinematic() && !shard.fault) body->end_kinematic_step();
    moved_.look_at(*body, batch);
  }
  moved_.hand_over(batch);
  shard.out_of_bounds = batch.out_of_bounds;
  for (SteppedJoint* joint : shard.joints)
    if (joint->axes() > 0 && !shard.fault) joint->update_position(config_.step_s);
}

void ShardSolver::solve(Shard& shard, std::int64_t step_number) {
  shard.quick = shard.quick_instead = false;
  shard.contacts.clear();
  const bool some_are_not_alone = step_lone_bodies(shard);
  if (!some_are_not_alone) return;  // ODE has nothing to do
  for (SteppedBody* body : shard.moving)
    if (body->gyroscopic() && !body->alone()) body->add_gyroscopic_torque(config_.step_s);
  start_joints(shard);
  // Without the bodies that were stepped.
  for (const SteppedBody* body : lone_) dBodyDisable(body->ode());
  memory_.lend_to(shard.world.get());
  call_solver(shard, step_number);
  memory_.take_back_from(shard.world.get());
  for (const SteppedBody* body : lone_) dBodyEnable(body->ode());
  // Read contact forces and joint loads.
  Collider::read_forces(making_, shard.contacts);
  dJointGroupEmpty(making_.contacts.get());
  for (SteppedJoint* joint : shard.joints)
    if (joint->is_measured()) joint->note_load();
  for (SteppedJoint* joint : leaving_) joint->end_leaving_stops();
}

/// Finds the bodies that have neither contacts nor joints, and steps them.  Returns whether others are left.
bool ShardSolver::step_lone_bodies(const Shard& shard) {
  lone_.clear();
  bool others = false;
  for (SteppedBody* body : shard.moving) {
    if (!body->free()) continue;
    if (body->takes_first_order_step() || islands_.rows_of(body->number()) > 0) {
      others = true;
      body->leave_to_ode(config_.step_s);
    } else {
      body->step_alone(config_.step_s, settings_.gravity_mps2);
      if (body->has_parts()) body->mark_parts_as_moved();
      lone_.push_back(body);
    }
    body->end_first_order_step();
  }
  return others;
}

void ShardSolver::start_joints(const Shard& shard) {
  leaving_.clear();
  for (SteppedJoint* joint : shard.joints) {
    joint->start_damping(making_.contacts.get());
    if (joint->start_leaving_stops(making_.contacts.get(), config_.step_s)) leaving_.push_back(joint);
  }
  // Record the poses at the start of the step for the joint loads.
  for (SteppedJoint* joint : shard.joints)
    if (joint->is_measured()) joint->note_before_step();
}

/// Selects the solver and steps the enabled bodies by it.
void ShardSolver::call_solver(Shard& shard, std::int64_t step_number) {
  if (config_.solver == PhysicsConfig::Solver::quick) {
    shard.quick = true;
    quick_step(shard.world.get(), step_number);
  } else if (config_.solver == PhysicsConfig::Solver::automatic && shard.max_rows > config_.quick_above_rows) {
    step_islands_by_size(shard, step_number);
  } else {
    step_exactly(shard, step_number);
  }
}

void ShardSolver::quick_step(dWorldID world, std::int64_t step_number) const {
  dRandSetSeed(step_seed(settings_.seed, step_number));
  dWorldQuickStep(world, config_.step_s);
}

bool ShardSolver::is_large(const SteppedBody& body) const {
  return islands_.rows_of(body.number()) > config_.quick_above_rows;
}

bool ShardSolver::is_mixed(const SteppedBody& body) const {
  return std::binary_search(mixed_islands_.begin(), mixed_islands_.end(), islands_.first_of(body.number()));
}

/// Steps the islands with too many rows as crowds or by QuickStep, the others by WorldStep.  ODE skips disabled bodies,
/// and nothing connects two islands.
void ShardSolver::step_islands_by_size(Shard& shard, std::int64_t step_number) {
  shard.quick = shard.quick_instead = true;
  sort_by_islands(shard);
  if (!mixed_.empty())
    step_all_but(small_, [&] { step_all_but(crowd_, [&] { quick_step(shard.world.get(), step_number); }); });
  push_crowds();  // then each of their vehicles is an island
  step_all_but(mixed_, [&] {
    step_or_fall_back(shard, step_number, [&](const SteppedBody& body) {
      return is_large(body) ? islands_.first_by_joints_of(body.number()) : islands_.first_of(body.number());
    });
  });
}

/// A crowd is an island of vehicles that push each other; anything else in it makes it a mixed one.
void ShardSolver::sort_by_islands(const Shard& shard) {
  mixed_islands_.clear();
  for (const SteppedBody* body : shard.moving) {
    if (!body->free() || body->alone()) continue;
    const int rows = islands_.joint_rows_of(body->number());
    if (rows == 0 || rows > config_.quick_above_rows || groups_[body->group()].anchored)
      mixed_islands_.push_back(islands_.first_of(body->number()));
  }
  for (const Collider::Between& contact : making_.between)
    if (!CrowdContacts::can_solve(contact.contact))
      mixed_islands_.push_back(islands_.first_of(body_of(contact.bodies[0]).number()));
  std::sort(mixed_islands_.begin(), mixed_islands_.end());
  for (std::vector<dBodyID>* each : {&small_, &crowd_, &mixed_}) each->clear();
  for (const SteppedBody* body : shard.moving)
    if (!body->alone()) (!is_large(*body) ? small_ : is_mixed(*body) ? mixed_ : crowd_).push_back(body->ode());
}

/// Finds the forces at the contacts between the vehicles of crowds, in place of the solver.
void ShardSolver::push_crowds() {
  crowd_contacts_.clear();
  for (const dBodyID ode : crowd_)
    if (const SteppedBody& body = body_of(ode); body.free())
      crowd_contacts_.add_body(ode, body.mass_kg(), body.inertia_C_B(), islands_.first_by_joints_of(body.number()));
  bool pushed = false;
  for (const Collider::Between& contact : making_.between) {
    const SteppedBody &a = body_of(contact.bodies[0]), &b = body_of(contact.bodies[1]);
    const SteppedBody& any = a.free() ? a : b;
    if (!is_large(any) || is_mixed(any)) continue;
    crowd_contacts_.add_contact(contact);
    dJointDisable(contact.joint);
    pushed = true;
  }
  if (pushed) crowd_contacts_.solve();
}

/// Steps the enabled bodies by dWorldStep.
void ShardSolver::step_exactly(Shard& shard, std::int64_t step_number) {
  if (config_.solver == PhysicsConfig::Solver::step)  // the user wants no other
    dWorldStep(shard.world.get(), config_.step_s);
  else
    step_or_fall_back(shard, step_number, [this](const SteppedBody& body) { return islands_.first_of(body.number()); });
}

/// Steps the enabled bodies by dWorldStep.  Where its solver gives up on an island, as in stacks of boxes, the forces
/// are incomplete and bodies would fall through the ground: the step of that island is then taken back, and made by
/// QuickStep.  `island_of(body)` is a number that only the bodies of an island have in common.
template <class IslandOf>
void ShardSolver::step_or_fall_back(Shard& shard, std::int64_t step_number, const IslandOf& island_of) {
  const dWorldID world = shard.world.get();
  before_.clear();
  for (const SteppedBody* body : shard.moving)
    if (dBodyIsEnabled(body->ode())) before_.emplace_back(body->ode());
  std::int64_t messages = ode_messages();
  dWorldStep(world, config_.step_s);
  if (ode_messages() == messages) return;
  // Make the step again, island by island: its result must not depend on what else the shard holds.
  std::map<int, std::vector<BodyCopy*>> by_island;
  for (BodyCopy& body : before_) {
    by_island[island_of(body_of(body.body()))].push_back(&body);
    body.write_back();
    dBodyDisable(body.body());
  }
  for (const auto& [number, together] : by_island) {
    for (const BodyCopy* body : together) dBodyEnable(body->body());
    messages = ode_messages();
    dWorldStep(world, config_.step_s);
    if (ode_messages() != messages) {
      for (BodyCopy* body : together) body->write_back();
      quick_step(world, step_number);
      shard.quick = shard.quick_instead = true;
    }
    for (const BodyCopy* body : together) dBodyDisable(body->body());
  }
  for (const BodyCopy& body : before_) dBodyEnable(body.body());
}

/// Names the lightest and the heaviest body of the island with the largest mass ratio: the usual cause when the solver
/// fails with finite inputs.  Returns the beginning of an error message, or an empty text.
std::string ShardSolver::suspects(const Shard& shard) const {
  std::map<int, std::pair<const Body*, const Body*>> islands_by_first;  // lightest, heaviest
  for (const SteppedBody* body : shard.moving) {
    if (!body->free()) continue;
    auto& [lightest, heaviest] = islands_by_first[islands_.first_of(body->number())];
    if (lightest == nullptr || body->mass_kg() < lightest->mass_kg()) lightest = body;
    if (heaviest == nullptr || body->mass_kg() > heaviest->mass_kg()) heaviest = body;
  }
  // Find the island with the largest mass ratio.
  const auto ratio = [](const auto& island) {
    return island.second.second->mass_kg() / island.second.first->mass_kg();
  };
  const auto worst = std::max_element(islands_by_first.begin(), islands_by_first.end(),
                                      [&](const auto& a, const auto& b) { return ratio(a) < ratio(b); });
  if (worst == islands_by_first.end()) return "";
  const auto [lightest, heaviest] = worst->second;
  if (lightest == heaviest) return "body '" + lightest->name() + "': ";
  return "body '" + lightest->name() + "' of " + number_text(lightest->mass_kg()) +
         " kg, in contact or joined with body '" + heaviest->name() + "' of " + number_text(heaviest->mass_kg()) +
         " kg: ";
}

}  // namespace sim
