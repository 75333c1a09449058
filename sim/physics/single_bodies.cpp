// SPDX-License-Identifier: BSD-3-Clause
// The step of groups that are one body without joints, as most marine vehicles are: while such a body touches nothing
// it does not go through ODE.
#include <algorithm>
#include <atomic>

#include "sim/physics/physics_world_impl.hpp"

namespace sim {

/// Sorts the shards into those that are one body without joints, and others.
void PhysicsWorld::Impl::list_shards() {
  if (parts_behind)  // also those of bodies that are no longer single
    for_each_moving([](const Body& body) { mark_as_moved(body); });
  parts_behind = false;
  singles.clear();
  other_shards.clear();
  for (int number = 0; number < static_cast<int>(shards.size()); ++number) {
    Shard* const shard = shards[number].get();
    if (shard == nullptr || shard->groups.empty()) continue;
    if (shard->stale) list_content(*shard);
    if (shard->moving.size() == 1 && shard->joints.empty())
      singles.push_back({shard->moving.front(), number});
    else
      other_shards.push_back(number);
  }
  steps_by_ode.assign(shards.size(), false);
  near_singles_known = false;
  shards_listed = true;
}

/// Steps the single bodies without pairs, and marks the shards of the others in steps_by_ode.  Returns whether a body
/// is out of bounds.
bool PhysicsWorld::Impl::step_singles() {
  std::atomic<bool> out = false;
  for_each_block(threads.get(), singles.size(), [&](std::size_t begin, std::size_t end) {
    bool some_out = false;
    std::vector<int> left, fast;
    for (std::size_t i = begin; i < end; ++i) {
      Body& body = *singles[i].body;
      if (steps_by_ode[singles[i].shard]) continue;
      if (body.first_order_ || body.first_order_now_) {
        step_by_ode_without_pairs(singles[i].shard);
        continue;
      }
      if (body.kinematic()) {
        body.start_kinematic_step();
        body.end_kinematic_step_alone();
      } else {
        body.step_alone(config.step_s, gravity_mps2);
      }
      collider.note_position(body.number_);
      some_out |= out_of_bounds(body);
      if (body.left_its_box()) left.push_back(body.group_);
      if (body.may_leap()) fast.push_back(body.number_);
    }
    if (some_out) out = true;
    note_left_boxes(left);
    note_may_leap(fast);
  });
  parts_behind = true;
  return out;
}

/// Lets ODE step a shard; its pairs were dealt if it is to do so already.
void PhysicsWorld::Impl::step_by_ode_without_pairs(int shard) {
  if (!steps_by_ode[shard]) shards[shard]->pairs.clear();
  steps_by_ode[shard] = true;
}

/// Marks the parts of the single bodies in the collision space as moved.
void PhysicsWorld::Impl::mark_near_singles() {
  if (!near_singles_known) {
    near_singles.clear();
    for (const Single& single : singles)
      if (!far_groups.far(single.body->group_) && dBodyGetFirstGeom(single.body->ode_.get()) != nullptr)
        near_singles.push_back(single.body);
    near_singles_known = true;
  }
  for (const Body* body : near_singles) mark_as_moved(*body);
}

/// Lets the parts of all single bodies follow them, before anything outside of the step looks at parts.
void PhysicsWorld::Impl::bring_parts() {
  if (!parts_behind) return;
  if (!shards_listed) return list_shards();
  parts_behind = false;
  for (const Single& single : singles) mark_as_moved(*single.body);
}

void PhysicsWorld::Impl::mark_as_moved(const Body& body) {
  dBodySetPosition(body.ode_.get(), body.p_WC_[0], body.p_WC_[1], body.p_WC_[2]);
}

void PhysicsWorld::Impl::note_left_boxes(const std::vector<int>& left) {
  if (left.empty()) return;
  const std::lock_guard lock(left_mutex);
  left_boxes.insert(left_boxes.end(), left.begin(), left.end());
}

}  // namespace sim
