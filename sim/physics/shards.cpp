// SPDX-License-Identifier: BSD-3-Clause
// Which groups share an ODE world: those whose boxes overlap, in the world of the one with the lowest number.
#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include "sim/physics/physics_world_impl.hpp"

namespace sim {

Shard& PhysicsWorld::Impl::shard(int number) {
  auto& made = slot(shards, number);
  if (made) return *made;
  made = std::make_unique<Shard>();
  made->world.reset(dWorldCreate());
  const dWorldID world = made->world.get();
  make_calls_at_once(world);
  dWorldSetGravity(world, 0, 0, -gravity_mps2);
  dWorldSetERP(world, config.erp);
  dWorldSetCFM(world, config.cfm);
  dWorldSetContactMaxCorrectingVel(world, config.contact_max_correcting_velocity_mps);
  dWorldSetContactSurfaceLayer(world, config.contact_surface_layer_m);
  dWorldSetQuickStepNumIterations(world, config.quick_iterations);
  // ODE's auto-disable has internal counters that a snapshot could not restore.
  dWorldSetAutoDisableFlag(world, 0);
  return *made;
}

/// Finds the pairs of this step, brings groups that may touch into one shard, and gives each shard its pairs.
void PhysicsWorld::Impl::deal_pairs(std::int64_t step_number) {
  if (!shards_listed) list_shards();
  update_far_groups();
  mark_near_singles();
  const std::vector<Collider::Pair>& pairs = collider.find_pairs();
  bool apart = false;
  for (const Collider::Pair pair : pairs) {
    const int a = shard_of_part[Collider::first_of(pair)], b = shard_of_part[Collider::second_of(pair)];
    apart |= a >= 0 && b >= 0 && a != b;
  }
  // Groups that are no longer together are separated from time to time: it makes no difference to their motion.
  constexpr std::int64_t steps_between_separations = 128;
  const bool separate = step_number % steps_between_separations == 0;
  if (apart || (separate && some_share_a_shard())) place_groups(pairs, separate);
  if (!shards_listed) list_shards();
  std::fill(steps_by_ode.begin(), steps_by_ode.end(), false);
  for (const Collider::Pair pair : pairs) {
    const int a = shard_of_part[Collider::first_of(pair)],
              number = a >= 0 ? a : shard_of_part[Collider::second_of(pair)];
    if (!steps_by_ode[number]) shards[number]->pairs.clear();
    steps_by_ode[number] = true;
    shards[number]->pairs.push_back(pair);
  }
}

bool PhysicsWorld::Impl::some_share_a_shard() const {
  return std::any_of(shards.begin(), shards.end(), [](const auto& each) { return each && each->groups.size() > 1; });
}

/// Assigns the groups to shards by the pairs; groups that share one already stay together unless `separate`.
void PhysicsWorld::Impl::place_groups(const std::vector<Collider::Pair>& pairs, bool separate) {
  // The lowest number of the groups that belong together.
  std::vector<int> lowest(groups.size());
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
    if (shard_of_part[a] >= 0 && shard_of_part[b] >= 0) join(parts[a].group, parts[b].group);
  }
  if (!separate)
    for (const auto& each : shards)
      if (each)
        for (const int group : each->groups) join(each->groups.front(), group);
  // List the groups of each shard that changes.
  std::map<int, std::vector<int>> desired;
  for (int group = 0; group < static_cast<int>(groups.size()); ++group)
    if (groups[group].shard >= 0 && groups[group].shard != find(group)) desired[find(group)];
  for (int group = 0; group < static_cast<int>(groups.size()); ++group)
    if (groups[group].shard >= 0)
      if (const auto at = desired.find(find(group)); at != desired.end()) at->second.push_back(group);
  for (const auto& [number, all] : desired) fill_shard(number, all);
}

/// Moves groups to a shard so that these (ascending) are created in their order.
void PhysicsWorld::Impl::fill_shard(int number, const std::vector<int>& desired) {
  std::vector<int> there;
  std::set_intersection(shard(number).groups.begin(), shard(number).groups.end(), desired.begin(), desired.end(),
                        std::back_inserter(there));
  const auto kept = std::mismatch(there.begin(), there.end(), desired.begin(), desired.end()).second;
  for (auto group = kept; group != desired.end(); ++group) move_to_shard(*group, number);
}

/// Creates the bodies and joints of a group again in another ODE world, or in the same one after all others.
void PhysicsWorld::Impl::move_to_shard(int number, int to) {
  Group& moved = groups[number];
  Shard& target = shard(to);
  std::erase(shards[moved.shard]->groups, number);
  shards[moved.shard]->stale = target.stale = true;
  shards_listed = false;
  // Bodies.
  std::map<dBodyID, std::pair<BodyHandle, Body*>> before;
  for (Body* body : moved.moving) {
    const dBodyID old = body->ode_.get();
    before[old] = {std::move(body->ode_), body};
    attach_ode_body(*body, target.world.get());
    const dBodyID ode = body->ode_.get();
    if (body->free()) {
      dMass mass;
      dBodyGetMass(old, &mass);
      dBodySetMass(ode, &mass);
    }
    dBodySetGravityMode(ode, dBodyGetGravityMode(old));
    dBodySetFiniteRotationMode(ode, dBodyGetFiniteRotationMode(old));
    BodyCopy(old).write_to(ode);
    if (!dBodyIsEnabled(old)) dBodyDisable(ode);
    collider.replace_body(body->number_, collision_body(*body));
  }
  // Joints, which need the bodies at other poses for a moment: before the parts.
  for (const int joint : moved.joints) {
    Joint& again = *joints[joint];
    const auto ode_of = [&](int end) {
      const auto body = before.find(dJointGetBody(again.ode_.get(), end));
      return body == before.end() ? nullptr : body->second.second->ode_.get();
    };
    again.create_again(target.world.get(), ode_of(0), ode_of(1));
  }
  // Parts.
  for (const auto& [old, body] : before)
    while (const dGeomID geom = dBodyGetFirstGeom(old)) {
      dVector3 p_CG;
      dMatrix3 R_CG;
      const bool offset = dGeomIsOffset(geom) != 0;
      if (offset) {
        std::copy_n(dGeomGetOffsetPosition(geom), 3, p_CG);
        std::copy_n(dGeomGetOffsetRotation(geom), 12, R_CG);
      }
      dGeomSetBody(geom, body.second->ode_.get());
      if (!offset) continue;
      dGeomSetOffsetPosition(geom, p_CG[0], p_CG[1], p_CG[2]);
      dGeomSetOffsetRotation(geom, R_CG);
    }
  moved.shard = to;
  for (const int part : moved.parts)
    if (shard_of_part[part] >= 0) shard_of_part[part] = to;
  target.groups.push_back(number);
}

/// Removes a group that is about to be destroyed, and moves the others out of its shard.
void PhysicsWorld::Impl::leave_shard(int number) {
  Group& leaving = groups[number];
  if (leaving.shard < 0) return;
  shards[leaving.shard]->stale = true;
  shards_listed = false;
  std::vector<int>& of_shard = shards[leaving.shard]->groups;
  std::erase(of_shard, number);
  if (leaving.shard == number && !of_shard.empty()) {
    const std::vector<int> others = of_shard;
    fill_shard(others.front(), others);
  }
  leaving.shard = -1;
}

}  // namespace sim
