// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/far_groups.hpp"

#include <algorithm>

namespace sim {

namespace {

constexpr double max_horizon_s = 1, min_horizon_s = 0.125;

}  // namespace

/// Gives each body of a group leeway for the time of the horizon at its present speed.  Returns the box that contains
/// the group meanwhile; none when nothing can touch it.
std::optional<AlignedBox> FarGroups::make_box(const Group& group) const {
  constexpr double min_leeway_m = 0.1, rounding_m = 1e-6;
  std::optional<AlignedBox> box;
  for (SteppedBody* body : group.moving) {
    if (!body->has_parts()) continue;
    const double leeway_m = min_leeway_m + horizon_s_ * to_eigen(body->v_WC_W()).norm();
    const Vector3d center_W = body->start_box(leeway_m);
    const Vector3d half = Vector3d::Constant(leeway_m + collider_.reach_m(body->number()) + rounding_m);
    if (!box) box = {center_W - half, center_W + half};
    box->low = box->low.cwiseMin(center_W - half);
    box->high = box->high.cwiseMax(center_W + half);
  }
  return box;
}

/// Makes the boxes of all groups, and finds which groups are far.
void FarGroups::find_all() {
  const auto share_is_far = [&](double share) {
    return static_cast<double>(boxes_.count()) >= share * static_cast<double>(boxes_.boxes());
  };
  const std::vector<AlignedBox> fixed = collider_.fixed_boxes();
  for (;; horizon_s_ /= 2) {  // where groups are close to each other, smaller boxes may not meet
    make_boxes();
    boxes_.find(fixed);
    if (share_is_far(0.9) || horizon_s_ <= min_horizon_s) break;
  }
  if (share_is_far(0.98)) horizon_s_ = std::min(1.25 * horizon_s_, max_horizon_s);
  // On a common ground it is not worth while: leave all in the collision space for some time.
  if (boxes_.boxes() == 0 || !share_is_far(0.25)) {
    constexpr int steps_until_next_attempt = 500;
    boxes_.clear(0);
    groups_.for_each_moving([](SteppedBody& body) { body.forget_box(); });
    steps_without_ = steps_until_next_attempt;
    horizon_s_ = max_horizon_s;
  }
  for (int number = 0; number < groups_.count(); ++number)
    if (groups_[number].shard >= 0) collider_.set_far(number, boxes_.far(number));
  ++changes_;
}

void FarGroups::make_boxes() {
  boxes_.clear(static_cast<std::size_t>(groups_.count()));
  for (int number = 0; number < groups_.count(); ++number)
    if (const auto box = make_box(groups_[number])) boxes_.set(number, *box);
}

void FarGroups::note(int number) {
  const Group& group = groups_[number];
  fixed_parts_changed_ |=
      std::any_of(group.bodies.begin(), group.bodies.end(), [this](int body) { return groups_.body(body).fixed(); });
  if (!group.moving.empty()) left_.push_back(number);
}

void FarGroups::note_left(const std::vector<int>& groups) {
  if (groups.empty()) return;
  const std::lock_guard lock(left_mutex_);
  left_.insert(left_.end(), groups.begin(), groups.end());
}

void FarGroups::update() {
  if (steps_without_ > 0) {
    --steps_without_;
    left_.clear();
    return;
  }
  const bool changed = fixed_parts_changed_ || fixed_moves_ != moves_.fixed;
  fixed_parts_changed_ = false;
  fixed_moves_ = moves_.fixed;
  if (jumps_ != moves_.jumps && !changed)
    groups_.for_each_moving([&](const SteppedBody& body) {
      if (body.left_its_box()) left_.push_back(body.group());
    });
  jumps_ = moves_.jumps;
  std::sort(left_.begin(), left_.end());
  left_.erase(std::unique(left_.begin(), left_.end()), left_.end());
  // Looking for the neighbors of one group takes about a thirtieth of making all boxes again.
  constexpr std::size_t max_single = 32;
  if (changed || left_.size() > max_single)
    find_all();
  else
    for (const int number : left_) move(number);
  left_.clear();
}

/// Makes the box of a group again, and brings it and those near it into the collision space.
void FarGroups::move(int number) {
  const auto box = make_box(groups_[number]);
  if (!box) return;
  boxes_.move(number, *box, [&](int near) {
    collider_.set_far(near, false);
    ++changes_;
  });
  collider_.set_far(number, boxes_.far(number));
}

}  // namespace sim
