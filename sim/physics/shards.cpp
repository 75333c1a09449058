// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/shards.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

namespace sim {

Shard& Shards::shard(int number) {
  auto& made = slot(shards_, number);
  if (made) return *made;
  made = std::make_unique<Shard>();
  made->world.reset(dWorldCreate());
  const dWorldID world = made->world.get();
  const PhysicsConfig& config = settings_.config;
  make_calls_at_once(world);
  dWorldSetGravity(world, 0, 0, -settings_.gravity_mps2);
  dWorldSetERP(world, config.erp);
  dWorldSetCFM(world, config.cfm);
  dWorldSetContactMaxCorrectingVel(world, config.contact_max_correcting_velocity_mps);
  dWorldSetContactSurfaceLayer(world, config.contact_surface_layer_m);
  dWorldSetQuickStepNumIterations(world, config.quick_iterations);
  // ODE's auto-disable has internal counters that a snapshot could not restore.
  dWorldSetAutoDisableFlag(world, 0);
  return *made;
}

dWorldID Shards::world_of(int number) {
  Group& group = groups_[number];
  if (group.shard < 0) {
    group.shard = number;
    shard(number).groups = {number};
  }
  return shard(group.shard).world.get();
}

void Shards::add_part(int part, int group, bool fixed) {
  slot(shard_of_part_, part) = fixed ? -1 : groups_[group].shard;
}

void Shards::note_change(int group) {
  if (const int number = groups_[group].shard; number >= 0) shard(number).stale = true;
  listed_ = false;
}

void Shards::set_gravity() {
  for (const auto& shard : shards_)
    if (shard) dWorldSetGravity(shard->world.get(), 0, 0, -settings_.gravity_mps2);
}

void Shards::list() {
  singles_.clear();
  others_.clear();
  for (int number = 0; number < static_cast<int>(shards_.size()); ++number) {
    Shard* const shard = shards_[number].get();
    if (shard == nullptr || shard->groups.empty()) continue;
    if (shard->stale) list_content(*shard);
    const bool single = shard->moving.size() == 1 && shard->joints.empty();
    (single ? singles_ : others_).push_back(number);
  }
  steps_by_ode_.assign(shards_.size(), false);
  listed_ = true;
}

void Shards::list_content(Shard& shard) const {
  shard.moving.clear();
  shard.joints.clear();
  for (const int number : shard.groups) {
    const Group& group = groups_[number];
    shard.moving.insert(shard.moving.end(), group.moving.begin(), group.moving.end());
    for (const int joint : group.joints) shard.joints.push_back(&groups_.joint(joint));
  }
  shard.stale = false;
}

void Shards::bring_together(const std::vector<Collider::Pair>& pairs, std::int64_t step_number) {
  bool apart = false;
  for (const Collider::Pair pair : pairs) {
    const int a = shard_of_part_[Collider::first_of(pair)], b = shard_of_part_[Collider::second_of(pair)];
    apart |= a >= 0 && b >= 0 && a != b;
  }
  constexpr std::int64_t steps_between_separations = 128;
  const bool separate = step_number % steps_between_separations == 0;
  if (apart || (separate && some_are_shared())) place_groups(pairs, separate);
}

bool Shards::some_are_shared() const {
  return std::any_of(shards_.begin(), shards_.end(), [](const auto& each) { return each && each->groups.size() > 1; });
}

/// Assigns the groups to shards by the pairs; groups that share one already stay together unless `separate`.
void Shards::place_groups(const std::vector<Collider::Pair>& pairs, bool separate) {
  // The lowest number of the groups that belong together.
  std::vector<int> lowest(static_cast<std::size_t>(groups_.count()));
  std::iota(lowest.begin(), lowest.end(), 0);
  const auto find = [&](int group) {
    while (lowest[group] != group) group = lowest[group] = lowest[lowest[group]];
    return group;
  };
  const auto join = [&](int a, int b) {
    a = find(a);
    b = find(b);
    lowest[std::max(a, b)] = std::min(a, b);
  };
  for (const Collider::Pair pair : pairs) {
    const int a = Collider::first_of(pair), b = Collider::second_of(pair);
    if (shard_of_part_[a] >= 0 && shard_of_part_[b] >= 0) join(collider_.parts()[a].group, collider_.parts()[b].group);
  }
  if (!separate)
    for (const auto& each : shards_)
      if (each)
        for (const int group : each->groups) join(each->groups.front(), group);
  // List the groups of each shard that changes.
  std::map<int, std::vector<int>> desired;
  for (int group = 0; group < groups_.count(); ++group)
    if (groups_[group].shard >= 0 && groups_[group].shard != find(group)) desired[find(group)];
  for (int group = 0; group < groups_.count(); ++group)
    if (groups_[group].shard >= 0)
      if (const auto at = desired.find(find(group)); at != desired.end()) at->second.push_back(group);
  for (const auto& [number, all] : desired) fill(number, all);
}

/// Moves groups to a shard so that these (ascending) are created in their order.
void Shards::fill(int number, const std::vector<int>& desired) {
  std::vector<int> there;
  std::set_intersection(shard(number).groups.begin(), shard(number).groups.end(), desired.begin(), desired.end(),
                        std::back_inserter(there));
  const auto kept = std::mismatch(there.begin(), there.end(), desired.begin(), desired.end()).second;
  for (auto group = kept; group != desired.end(); ++group) move(*group, number);
}

namespace {

/// Moves the parts of an ODE body to another one.
void hand_over_geoms(dBodyID from, dBodyID to) {
  while (const dGeomID geom = dBodyGetFirstGeom(from)) {
    dVector3 p_CG;
    dMatrix3 R_CG;
    const bool offset = dGeomIsOffset(geom) != 0;
    if (offset) {
      std::copy_n(dGeomGetOffsetPosition(geom), 3, p_CG);
      std::copy_n(dGeomGetOffsetRotation(geom), 12, R_CG);
    }
    dGeomSetBody(geom, to);
    if (!offset) continue;
    dGeomSetOffsetPosition(geom, p_CG[0], p_CG[1], p_CG[2]);
    dGeomSetOffsetRotation(geom, R_CG);
  }
}

}  // namespace

/// Creates the bodies and joints of a group again in another ODE world, or in the same one after all others.
void Shards::move(int number, int to) {
  Group& moved = groups_[number];
  Shard& target = shard(to);
  std::erase(shards_[moved.shard]->groups, number);
  shards_[moved.shard]->stale = target.stale = true;
  listed_ = false;
  std::map<dBodyID, std::pair<BodyHandle, SteppedBody*>> before;
  for (SteppedBody* body : moved.moving) {
    BodyHandle old = body->create_again(target.world.get());
    const dBodyID key = old.get();
    before[key] = {std::move(old), body};
    collider_.replace_body(body->number(), body->for_collider());
  }
  // Joints, which need the bodies at other poses for a moment: before the parts.
  for (const int joint : moved.joints) {
    SteppedJoint& again = groups_.joint(joint);
    const auto ode_of = [&](int end) {
      const auto body = before.find(dJointGetBody(again.ode(), end));
      return body == before.end() ? nullptr : body->second.second->ode();
    };
    again.create_again(target.world.get(), ode_of(0), ode_of(1));
  }
  for (const auto& [old, body] : before) hand_over_geoms(old, body.second->ode());
  moved.shard = to;
  for (const int part : moved.parts)
    if (shard_of_part_[part] >= 0) shard_of_part_[part] = to;
  target.groups.push_back(number);
}

void Shards::leave(int number) {
  Group& leaving = groups_[number];
  if (leaving.shard < 0) return;
  shards_[leaving.shard]->stale = true;
  listed_ = false;
  std::vector<int>& of_shard = shards_[leaving.shard]->groups;
  std::erase(of_shard, number);
  if (leaving.shard == number && !of_shard.empty()) {
    const std::vector<int> others = of_shard;
    fill(others.front(), others);
  }
  leaving.shard = -1;
}

void Shards::destroy_if_empty(int number) {
  if (shards_[number]->groups.empty()) shards_[number].reset();
  listed_ = false;
}

void Shards::give_pairs(const std::vector<Collider::Pair>& pairs) {
  std::fill(steps_by_ode_.begin(), steps_by_ode_.end(), false);
  for (const Collider::Pair pair : pairs) {
    const int a = shard_of_part_[Collider::first_of(pair)],
              number = a >= 0 ? a : shard_of_part_[Collider::second_of(pair)];
    step_by_ode(number);
    shards_[number]->pairs.push_back(pair);
  }
}

void Shards::step_by_ode(int number) {
  if (!steps_by_ode_[number]) shards_[number]->pairs.clear();
  steps_by_ode_[number] = true;
}

bool Shards::step(ThreadPool* threads, std::int64_t step_number) {
  for (const int number : others_) step_by_ode(number);
  stepped_.clear();
  for (std::size_t number = 0; number < shards_.size(); ++number)
    if (steps_by_ode_[number]) stepped_.push_back(shards_[number].get());
  constexpr std::size_t min_shared_shards = 4;  // waking threads costs as much as a few vehicles
  const bool shared = threads != nullptr && threads->threads() > 1 && stepped_.size() >= min_shared_shards;
  // ODE marks moved parts up to the space of all groups, which is not for several threads: marked before, it is left.
  if (shared)
    for (const Shard* shard : stepped_)
      for (const SteppedBody* body : shard->moving)
        if (body->has_parts()) body->mark_parts_as_moved();
  // Neighbors in one task, since their memory is near too; but enough tasks for all threads.
  const std::size_t thread_count = shared ? static_cast<std::size_t>(threads->threads()) : 1;
  const std::size_t shards_per_task = std::clamp<std::size_t>(stepped_.size() / (4 * thread_count), 1, 8);
  const auto step_task = [&](std::size_t task) {
    step_some(task * shards_per_task, std::min(stepped_.size(), (task + 1) * shards_per_task), step_number);
  };
  const std::size_t tasks = (stepped_.size() + shards_per_task - 1) / shards_per_task;
  if (shared)
    threads->for_each(tasks, step_task);
  else
    for (std::size_t task = 0; task < tasks; ++task) step_task(task);
  return std::any_of(stepped_.begin(), stepped_.end(), [](const Shard* shard) { return shard->out_of_bounds; });
}

void Shards::step_some(std::size_t begin, std::size_t end, std::int64_t step_number) {
  start_ode();  // in this thread
  std::unique_ptr<ShardSolver> solver = take_solver();
  bool failed = false;
  for (std::size_t i = begin; i < end && !failed; ++i) {
    solver->step(*stepped_[i], step_number);
    failed = stepped_[i]->solver_failed;
  }
  const std::lock_guard lock(solvers_mutex_);
  (failed ? spoiled_solvers_ : solvers_).push_back(std::move(solver));
}

std::unique_ptr<ShardSolver> Shards::take_solver() {
  {
    const std::lock_guard lock(solvers_mutex_);
    if (!solvers_.empty()) {
      std::unique_ptr<ShardSolver> solver = std::move(solvers_.back());
      solvers_.pop_back();
      return solver;
    }
  }
  return std::make_unique<ShardSolver>(settings_, groups_, collider_, islands_, moved_);
}

}  // namespace sim
