// SPDX-License-Identifier: BSD-3-Clause
// Takes groups that are far from everything out of the collision space, and brings them back.
#include <algorithm>
#include <limits>

#include "sim/ode/ode_math.hpp"
#include "sim/physics/physics_world_impl.hpp"

namespace sim {

namespace {

constexpr double max_horizon_s = 1, min_horizon_s = 0.125;

}  // namespace

/// Gives each body of a group leeway for the time of the horizon at its present speed.  Returns the box that contains
/// the group meanwhile; none when nothing can touch it.
std::optional<AlignedBox> PhysicsWorld::Impl::make_box(const Group& group) {
  constexpr double min_leeway_m = 0.1, rounding_m = 1e-6;
  std::optional<AlignedBox> box;
  for (Body* body : group.moving) {
    if (dBodyGetFirstGeom(body->ode_.get()) == nullptr) continue;
    const Vector3d center_W = to_eigen(body->p_WC_);
    body->box_center_W_ = center_W;
    body->leeway_m_ = min_leeway_m + far_horizon_s * to_eigen(body->v_WC_W_).norm();
    const Vector3d half = Vector3d::Constant(body->leeway_m_ + collider.reach_m(body->number_) + rounding_m);
    if (!box) box = {center_W - half, center_W + half};
    box->low = box->low.cwiseMin(center_W - half);
    box->high = box->high.cwiseMax(center_W + half);
  }
  return box;
}

/// Makes the boxes of all groups, and finds which groups are far.
void PhysicsWorld::Impl::find_far_groups() {
  const auto share_is_far = [&](double share) {
    return static_cast<double>(far_groups.count()) >= share * static_cast<double>(far_groups.boxes());
  };
  const std::vector<AlignedBox> fixed = collider.fixed_boxes();
  for (;; far_horizon_s /= 2) {  // where groups are close to each other, smaller boxes may not meet
    far_groups.clear(groups.size());
    for (int number = 0; number < static_cast<int>(groups.size()); ++number)
      if (const auto box = make_box(groups[number])) far_groups.set(number, *box);
    far_groups.find(fixed);
    if (share_is_far(0.9) || far_horizon_s <= min_horizon_s) break;
  }
  if (share_is_far(0.98)) far_horizon_s = std::min(1.25 * far_horizon_s, max_horizon_s);
  // On a common ground it is not worth while: leave all in the collision space for some time.
  if (far_groups.boxes() == 0 || !share_is_far(0.25)) {
    constexpr int steps_until_next_attempt = 500;
    far_groups.clear(0);
    for_each_moving([](Body& body) { body.leeway_m_ = std::numeric_limits<double>::infinity(); });
    steps_without_far_groups = steps_until_next_attempt;
    far_horizon_s = max_horizon_s;
  }
  for (int number = 0; number < static_cast<int>(groups.size()); ++number)
    if (groups[number].shard >= 0) collider.set_far(number, far_groups.far(number));
  near_singles_known = false;
}

/// Notes that a group was added, or is about to be removed.
void PhysicsWorld::Impl::note_group(int number) {
  const Group& group = groups[number];
  fixed_parts_changed |=
      std::any_of(group.bodies.begin(), group.bodies.end(), [this](int body) { return bodies[body]->fixed(); });
  if (!group.moving.empty()) left_boxes.push_back(number);
}

/// Brings groups that may touch something in this step into the collision space.
void PhysicsWorld::Impl::update_far_groups() {
  if (steps_without_far_groups > 0) {
    --steps_without_far_groups;
    left_boxes.clear();
    return;
  }
  const bool changed = fixed_parts_changed || far_fixed_moves != moves.fixed;
  fixed_parts_changed = false;
  far_fixed_moves = moves.fixed;
  if (far_jumps != moves.jumps && !changed)
    for_each_moving([&](const Body& body) {
      if (body.left_its_box()) left_boxes.push_back(body.group_);
    });
  far_jumps = moves.jumps;
  // Looking for the neighbors of one group takes about a thirtieth of making all boxes again.
  constexpr std::size_t max_single = 32;
  std::sort(left_boxes.begin(), left_boxes.end());
  left_boxes.erase(std::unique(left_boxes.begin(), left_boxes.end()), left_boxes.end());
  if (changed || left_boxes.size() > max_single) {
    find_far_groups();
  } else {
    for (const int number : left_boxes) {
      const auto box = make_box(groups[number]);
      if (!box) continue;
      far_groups.move(number, *box, [&](int near) {
        collider.set_far(near, false);
        near_singles_known = false;
      });
      collider.set_far(number, far_groups.far(number));
    }
  }
  left_boxes.clear();
}

}  // namespace sim
