// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/single_bodies.hpp"

#include <atomic>

namespace sim {

void SingleBodies::list() {
  if (parts_behind_)  // also those of bodies that are no longer single
    groups_.for_each_moving([](const SteppedBody& body) { body.mark_parts_as_moved(); });
  parts_behind_ = false;
  shards_.list();
  singles_.clear();
  for (const int number : shards_.singles()) singles_.push_back({shards_[number].moving.front(), number});
  near_known_ = false;
}

bool SingleBodies::step(ThreadPool* threads) {
  std::atomic<bool> out = false;
  for_each_block(threads, singles_.size(), [&](std::size_t begin, std::size_t end) {
    MovedBodies::Batch batch;
    for (std::size_t i = begin; i < end; ++i) {
      SteppedBody& body = *singles_[i].body;
      if (shards_.steps_by_ode(singles_[i].shard)) continue;
      if (body.takes_first_order_step()) {
        shards_.step_by_ode(singles_[i].shard);
        continue;
      }
      step_alone(body);
      moved_.look_at(body, batch);
    }
    if (batch.out_of_bounds) out = true;
    moved_.hand_over(batch);
  });
  parts_behind_ = true;
  return out;
}

void SingleBodies::step_alone(SteppedBody& body) const {
  if (body.kinematic()) {
    body.start_kinematic_step();
    body.end_kinematic_step_alone();
  } else {
    body.step_alone(settings_.config.step_s, settings_.gravity_mps2);
  }
}

void SingleBodies::mark_near() {
  if (!near_known_ || near_changes_ != far_groups_.changes()) {
    near_.clear();
    for (const Single& single : singles_)
      if (!far_groups_.far(single.body->group()) && single.body->has_parts()) near_.push_back(single.body);
    near_known_ = true;
    near_changes_ = far_groups_.changes();
  }
  for (const SteppedBody* body : near_) body->mark_parts_as_moved();
}

void SingleBodies::bring_parts() {
  if (!parts_behind_) return;
  if (!shards_.listed()) return list();
  parts_behind_ = false;
  for (const Single& single : singles_) single.body->mark_parts_as_moved();
}

}  // namespace sim
