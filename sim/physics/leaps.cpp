// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/leaps.hpp"

#include <algorithm>
#include <limits>

namespace sim {

namespace {

/// Returns the box of all parts of a body, in the axes of the world; an empty one without parts.
Eigen::AlignedBox3d box_around(dBodyID ode) {
  Eigen::AlignedBox3d box;
  for (dGeomID geom = dBodyGetFirstGeom(ode); geom != nullptr; geom = dBodyGetNextGeom(geom)) {
    dReal sides[6];
    dGeomGetAABB(geom, sides);
    box.extend(Eigen::AlignedBox3d(Vector3d(sides[0], sides[2], sides[4]), Vector3d(sides[1], sides[3], sides[5])));
  }
  return box;
}

}  // namespace

void Leaps::plan(const Group& group) const {
  for (SteppedBody* body : group.moving) {
    if (!body->free()) continue;
    const Eigen::AlignedBox3d box = box_around(body->ode());
    if (box.isEmpty()) continue;
    const double speed_mps = box.sizes().minCoeff() / step_s_;
    body->set_leap_speed(speed_mps * speed_mps);
  }
}

void Leaps::plan_anew() {
  fast_.clear();
  leaps_.clear();
  for (const Group& group : groups_.all())
    if (group.in_use) plan(group);
}

void Leaps::note_fast(const std::vector<int>& bodies) {
  if (bodies.empty()) return;
  const std::lock_guard lock(fast_mutex_);
  fast_.insert(fast_.end(), bodies.begin(), bodies.end());
}

void Leaps::find() {
  if (fast_.empty()) return;
  std::sort(fast_.begin(), fast_.end());
  for (const int number : fast_)
    if (SteppedBody& body = groups_.body(number); !far_groups_.far(body.group())) look_at(body);
  fast_.clear();
}

void Leaps::look_at(SteppedBody& body) {
  const Vector3d v_W = to_eigen(body.v_WC_W());
  const double speed_mps = v_W.norm(), moved_m = speed_mps * step_s_;
  body.mark_parts_as_moved();
  const double size_m = box_around(body.ode()).sizes().dot(v_W.cwiseAbs()) / speed_mps;
  constexpr double faster = 1.2;  // until it is looked at again, for it may turn
  body.set_leap_speed(faster * faster * speed_mps * speed_mps);
  if (moved_m <= size_m) return;
  body.set_leap_speed(std::numeric_limits<double>::infinity());
  leaps_.push_back({body.number(), moved_m, size_m});
}

}  // namespace sim
