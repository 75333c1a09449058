// SPDX-License-Identifier: BSD-3-Clause
// The step of a shard: contacts, forces, solver, checks.
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "sim/ode/ode_math.hpp"
#include "sim/physics/physics_world_impl.hpp"
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

const Body& body_of(dBodyID ode) {
  return *static_cast<const Body*>(dBodyGetData(ode));
}

/// Steps the enabled bodies without some others.
template <class Step>
void step_all_but(const std::vector<dBodyID>& others, const Step& step) {
  for (const dBodyID body : others) dBodyDisable(body);
  step();
  for (const dBodyID body : others) dBodyEnable(body);
}

}  // namespace

void PhysicsWorld::Impl::step_shards(std::int64_t step_number) {
  bool out = step_singles();
  for (const int number : other_shards) step_by_ode_without_pairs(number);
  filled_.clear();
  for (std::size_t number = 0; number < shards.size(); ++number)
    if (steps_by_ode[number]) filled_.push_back(shards[number].get());
  constexpr std::size_t min_shared_shards = 4;  // waking threads costs as much as a few vehicles
  const bool shared = threads && threads->threads() > 1 && filled_.size() >= min_shared_shards;
  // ODE marks moved parts up to the space of all groups, which is not for several threads: marked before, it is left.
  if (shared)
    for (const Shard* shard : filled_)
      for (const Body* body : shard->moving)
        if (dBodyGetFirstGeom(body->ode_.get()) != nullptr) mark_as_moved(*body);
  // Neighbors in one task, since their memory is near too; but enough tasks for all threads.
  const std::size_t thread_count = shared ? static_cast<std::size_t>(threads->threads()) : 1;
  const std::size_t shards_per_task = std::clamp<std::size_t>(filled_.size() / (4 * thread_count), 1, 8);
  const auto step_some = [&](std::size_t task) {
    start_ode();  // in this thread
    std::unique_ptr<ShardStepper> stepper;
    {
      const std::lock_guard lock(steppers_mutex);
      if (!steppers.empty()) {
        stepper = std::move(steppers.back());
        steppers.pop_back();
      }
    }
    if (!stepper) stepper = std::make_unique<ShardStepper>(config);
    const std::size_t end = std::min(filled_.size(), (task + 1) * shards_per_task);
    bool failed = false;
    for (std::size_t i = task * shards_per_task; i < end && !failed; ++i) {
      step_shard(*filled_[i], *stepper, step_number);
      failed = filled_[i]->solver_failed;
    }
    const std::lock_guard lock(steppers_mutex);
    (failed ? spoiled_steppers : steppers).push_back(std::move(stepper));
  };
  const std::size_t tasks = (filled_.size() + shards_per_task - 1) / shards_per_task;
  if (shared)
    threads->for_each(tasks, step_some);
  else
    for (std::size_t task = 0; task < tasks; ++task) step_some(task);
  // Bring the results together.
  counts = {0, islands.max_rows_of_joints(), false};
  contact_reports.clear();
  bool quick_instead = false;
  for (const Shard* shard : filled_) {
    broken |= shard->solver_failed;
    out |= shard->out_of_bounds;
    counts.contacts += shard->contact_count;
    counts.max_island_rows = std::max(counts.max_island_rows, shard->max_rows);
    counts.quick |= shard->quick;
    quick_instead |= shard->quick_instead;
    contact_reports.insert(contact_reports.end(), shard->contacts.begin(), shard->contacts.end());
  }
  if (quick_instead) ++quick_steps;
  std::stable_sort(contact_reports.begin(), contact_reports.end(), [](const ContactReport& a, const ContactReport& b) {
    return std::pair(a.parts[0], a.parts[1]) < std::pair(b.parts[0], b.parts[1]);
  });
  // Report the first fault.
  if (out)
    for_each_moving([&](const Body& body) {
      if (out_of_bounds(body)) fault(body, step_number);
    });
  for (const Shard* shard : filled_)
    if (shard->fault) std::rethrow_exception(shard->fault);
}

void PhysicsWorld::Impl::list_content(Shard& shard) {
  shard.moving.clear();
  shard.joints.clear();
  for (const int group : shard.groups) {
    shard.moving.insert(shard.moving.end(), groups[group].moving.begin(), groups[group].moving.end());
    for (const int joint : groups[group].joints) shard.joints.push_back(joints[joint].get());
  }
  shard.stale = false;
}

void PhysicsWorld::Impl::step_shard(Shard& shard, ShardStepper& stepper, std::int64_t step_number) {
  shard.fault = nullptr;
  shard.solver_failed = shard.out_of_bounds = false;
  try {
    for (Body* body : shard.moving)
      if (body->kinematic()) body->start_kinematic_step();
    if (!shard.pairs.empty())
      for (Body* body : shard.moving)
        if (body->planned_) body->apply_plan();
    std::sort(shard.pairs.begin(), shard.pairs.end());
    collider.make_contacts(shard.pairs, shard.world.get(), islands, stepper.making);
    shard.contact_count = stepper.making.count;
    shard.max_rows = stepper.making.max_rows;
    solve(shard, stepper, step_number);
  } catch (const PhysicsFault& error) {
    shard.solver_failed = true;
    shard.fault = std::make_exception_ptr(PhysicsFault(suspects(shard) + "the solver failed at step " +
                                                       std::to_string(step_number) + " (" + error.what() + ")"));
  }
  // Kinematic bodies reach their poses, and joints their positions.
  std::vector<int> left, fast;
  for (Body* body : shard.moving) {
    if (body->kinematic() && !shard.fault) body->end_kinematic_step();
    shard.out_of_bounds |= out_of_bounds(*body);
    collider.note_position(body->number_);
    if (body->left_its_box()) left.push_back(body->group_);
    if (body->may_leap()) fast.push_back(body->number_);
  }
  note_left_boxes(left);
  note_may_leap(fast);
  for (Joint* joint : shard.joints)
    if (joint->axes() > 0 && !shard.fault) joint->update_position(config.step_s);
}

void PhysicsWorld::Impl::solve(Shard& shard, ShardStepper& stepper, std::int64_t step_number) {
  shard.quick = shard.quick_instead = false;
  shard.contacts.clear();
  const bool some_are_not_alone = step_lone_bodies(shard, stepper);
  if (!some_are_not_alone) return;  // ODE has nothing to do
  for (Body* body : shard.moving)
    if (body->gyroscopic_ && !body->alone()) body->add_gyroscopic_torque(config.step_s);
  stepper.leaving.clear();
  for (Joint* joint : shard.joints) {
    joint->start_damping(stepper.making.contacts.get());
    if (joint->start_leaving_stops(stepper.making.contacts.get(), config.step_s)) stepper.leaving.push_back(joint);
  }
  // Record the poses at the start of the step for the joint loads.
  const auto for_each_measured_joint = [&](const auto& visit) {
    for (Joint* joint : shard.joints)
      if (joint->is_measured()) visit(*joint);
  };
  for_each_measured_joint([](Joint& joint) { joint.note_before_step(); });
  // Select the solver.  WorldStep is exact and its cost grows with the cube of an island's rows; the selection depends
  // on the rows only, never on measured time.
  for (const Body* body : stepper.lone) dBodyDisable(body->ode_.get());
  stepper.memory.lend_to(shard.world.get());
  if (config.solver == PhysicsConfig::Solver::quick) {
    shard.quick = true;
    dRandSetSeed(step_seed(seed, step_number));
    dWorldQuickStep(shard.world.get(), config.step_s);
  } else if (config.solver == PhysicsConfig::Solver::automatic && shard.max_rows > config.quick_above_rows) {
    step_islands_by_size(shard, stepper, step_number);
  } else {
    step_exactly(shard, stepper, step_number);
  }
  stepper.memory.take_back_from(shard.world.get());
  for (const Body* body : stepper.lone) dBodyEnable(body->ode_.get());
  // Read contact forces and joint loads.
  Collider::read_forces(stepper.making, shard.contacts);
  dJointGroupEmpty(stepper.making.contacts.get());
  for_each_measured_joint([](Joint& joint) { joint.note_load(); });
  for (Joint* joint : stepper.leaving) joint->end_leaving_stops();
}

bool PhysicsWorld::Impl::is_large(const Body& body) {
  return islands.rows_of(body.number_) > config.quick_above_rows;
}

/// Finds the bodies that have neither contacts nor joints, and steps them.  Returns whether others are left.
bool PhysicsWorld::Impl::step_lone_bodies(const Shard& shard, ShardStepper& stepper) {
  stepper.lone.clear();
  bool others = false;
  for (Body* body : shard.moving) {
    if (!body->free()) continue;
    if (body->first_order_ || body->first_order_now_ || islands.rows_of(body->number_) > 0) {
      others = true;
      body->leave_to_ode(config.step_s);
    } else {
      body->step_alone(config.step_s, gravity_mps2);
      if (dBodyGetFirstGeom(body->ode_.get()) != nullptr) mark_as_moved(*body);
      stepper.lone.push_back(body);
    }
    body->first_order_now_ = false;
  }
  return others;
}

/// Steps the islands with too many rows as crowds or by QuickStep, the others by WorldStep.  ODE skips disabled bodies,
/// and nothing connects two islands.
void PhysicsWorld::Impl::step_islands_by_size(Shard& shard, ShardStepper& stepper, std::int64_t step_number) {
  shard.quick = shard.quick_instead = true;
  std::vector<dBodyID>&small = stepper.small, &crowd = stepper.crowd, &mixed = stepper.mixed;
  for (std::vector<dBodyID>* each : {&small, &crowd, &mixed}) each->clear();
  // A crowd is an island of vehicles that push each other; anything else in it makes it a mixed one.
  std::vector<int> mixed_islands;
  for (const Body* body : shard.moving) {
    if (!body->free() || body->alone()) continue;
    const int rows = islands.joint_rows_of(body->number_);
    if (rows == 0 || rows > config.quick_above_rows || groups[body->group_].anchored)
      mixed_islands.push_back(islands.first_of(body->number_));
  }
  for (const Collider::Between& contact : stepper.making.between)
    if (!CrowdContacts::can_solve(contact.contact))
      mixed_islands.push_back(islands.first_of(body_of(contact.bodies[0]).number_));
  std::sort(mixed_islands.begin(), mixed_islands.end());
  for (const Body* body : shard.moving) {
    if (body->alone()) continue;
    const bool is_mixed =
        std::binary_search(mixed_islands.begin(), mixed_islands.end(), islands.first_of(body->number_));
    (!is_large(*body) ? small : is_mixed ? mixed : crowd).push_back(body->ode_.get());
  }
  // Mixed islands.
  if (!mixed.empty()) {
    step_all_but(small, [&] {
      step_all_but(crowd, [&] {
        dRandSetSeed(step_seed(seed, step_number));
        dWorldQuickStep(shard.world.get(), config.step_s);
      });
    });
  }
  // Crowds: then each vehicle is an island.
  stepper.crowd_contacts.clear();
  for (const dBodyID body : crowd)
    if (body_of(body).free())
      stepper.crowd_contacts.add_body(body_of(body), islands.first_by_joints_of(body_of(body).number_), body);
  bool pushed = false;
  for (const Collider::Between& contact : stepper.making.between) {
    const Body &a = body_of(contact.bodies[0]), &b = body_of(contact.bodies[1]);
    const Body& any = a.free() ? a : b;
    if (!is_large(any) || std::binary_search(mixed_islands.begin(), mixed_islands.end(), islands.first_of(any.number_)))
      continue;
    stepper.crowd_contacts.add_contact(contact);
    dJointDisable(contact.joint);
    pushed = true;
  }
  if (pushed) stepper.crowd_contacts.solve();
  step_all_but(mixed, [&] {
    step_or_fall_back(shard, stepper, step_number, [&](const Body& body) {
      return is_large(body) ? islands.first_by_joints_of(body.number_) : islands.first_of(body.number_);
    });
  });
}

/// Steps the enabled bodies by dWorldStep.
void PhysicsWorld::Impl::step_exactly(Shard& shard, ShardStepper& stepper, std::int64_t step_number) {
  if (config.solver == PhysicsConfig::Solver::step)  // the user wants no other
    dWorldStep(shard.world.get(), config.step_s);
  else
    step_or_fall_back(shard, stepper, step_number, [this](const Body& body) { return islands.first_of(body.number_); });
}

/// Steps the enabled bodies by dWorldStep.  Where its solver gives up on an island, as in stacks of boxes, the forces
/// are incomplete and bodies would fall through the ground: the step of that island is then taken back, and made by
/// QuickStep.  `island_of(body)` is a number that only the bodies of an island have in common.
template <class IslandOf>
void PhysicsWorld::Impl::step_or_fall_back(Shard& shard, ShardStepper& stepper, std::int64_t step_number,
                                           const IslandOf& island_of) {
  const dWorldID world = shard.world.get();
  stepper.before.clear();
  for (const Body* body : shard.moving)
    if (dBodyIsEnabled(body->ode_.get())) stepper.before.emplace_back(body->ode_.get());
  std::int64_t messages = ode_messages();
  dWorldStep(world, config.step_s);
  if (ode_messages() == messages) return;
  // Make the step again, island by island: its result must not depend on what else the shard holds.
  std::map<int, std::vector<BodyCopy*>> by_island;
  for (BodyCopy& body : stepper.before) {
    by_island[island_of(body_of(body.body()))].push_back(&body);
    body.write_back();
    dBodyDisable(body.body());
  }
  for (const auto& [number, together] : by_island) {
    for (const BodyCopy* body : together) dBodyEnable(body->body());
    messages = ode_messages();
    dWorldStep(world, config.step_s);
    if (ode_messages() != messages) {
      for (BodyCopy* body : together) body->write_back();
      dRandSetSeed(step_seed(seed, step_number));
      dWorldQuickStep(world, config.step_s);
      shard.quick = shard.quick_instead = true;
    }
    for (const BodyCopy* body : together) dBodyDisable(body->body());
  }
  for (const BodyCopy& body : stepper.before) dBodyEnable(body.body());
}

}  // namespace sim
